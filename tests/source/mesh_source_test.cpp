#include <bandvox/core/error.h>
#include <bandvox/source/mesh_source.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;

Mesh tetrahedron(const Vec3d& offset, double size) {
    Mesh mesh;
    mesh.points = {offset, offset + Vec3d(size, 0, 0), offset + Vec3d(0, size, 0),
                   offset + Vec3d(0, 0, size)};
    mesh.triangles = {Vec3I(0, 2, 1), Vec3I(0, 1, 3), Vec3I(0, 3, 2), Vec3I(1, 2, 3)};
    return mesh;
}

/// Every rule twice as large as the one before, so that each gets its turn.
SurfaceQuadrature testQuadrature() {
    SurfaceQuadrature quadrature;
    for (int i = 0; i < kTriangleRules; ++i) quadrature.triangleEdge[i] = 0.05 * std::exp2(i);
    for (int i = 0; i < kIntervalRules; ++i) quadrature.cellSide[i] = 0.05 * std::exp2(i);
    return quadrature;
}

std::vector<SurfaceSample> sampleAll(const BoundarySource& source, const SamplingRegion& region,
                                     const SurfaceQuadrature& quadrature) {
    std::vector<SurfaceSample> samples;
    for (std::size_t i = 0; i < source.elementCount(); ++i) {
        source.sampleElement(i, region, quadrature, samples);
    }
    return samples;
}

TEST(MeshSource, MeasuresATetrahedron) {
    const MeshSource source("tetrahedron", tetrahedron(Vec3d(1, 2, 3), 2.0));
    EXPECT_EQ(source.name(), "tetrahedron");
    EXPECT_EQ(source.elementCount(), 4u);
    EXPECT_NEAR(source.volume(), 8.0 / 6.0, 1e-15);
    EXPECT_NEAR(source.area(), 3 * 2.0 + 2.0 * std::sqrt(3.0), 1e-14);
    EXPECT_EQ(source.bounds().min(), Vec3d(1, 2, 3));
    EXPECT_EQ(source.bounds().max(), Vec3d(3, 4, 5));
    EXPECT_EQ(source.elementBounds(0).max(), Vec3d(3, 4, 3));
}

TEST(MeshSource, MeasuresFarFromTheOrigin) {
    const Vec3d far(1 << 20, -(1 << 21), 1 << 22);
    EXPECT_NEAR(MeshSource("far", tetrahedron(far, 0.5)).volume(), 0.125 / 6.0, 1e-16);
}

TEST(MeshSource, MeasuresNothing) {
    const MeshSource source("empty", Mesh{});
    EXPECT_EQ(source.elementCount(), 0u);
    EXPECT_EQ(source.volume(), 0.0);
    EXPECT_EQ(source.area(), 0.0);
    EXPECT_TRUE(source.bounds().empty());
}

TEST(MeshSource, RefusesCoordinatesThatAreNotFinite) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e200}) {
        Mesh mesh = tetrahedron(Vec3d(0), 1.0);
        mesh.points[2].x() = bad;
        EXPECT_THROW(MeshSource("bad", mesh), Error) << bad;
    }
}

TEST(MeshSource, SamplesIntegrateConstantsAndVolume) {
    const SurfaceQuadrature quadrature = testQuadrature();
    // From a fraction of a voxel, where one low rule does, to 40 voxels, where all split.
    for (const double size : {0.03, 0.2, 0.7, 2.5, 9.0, 40.0}) {
        const MeshSource source("tetrahedron", tetrahedron(Vec3d(0), size));
        const SamplingRegion region{0.5, Vec3d(-100), Vec3d(400)};
        const std::vector<SurfaceSample> samples = sampleAll(source, region, quadrature);

        Vec3d sum(0);
        double volume = 0.0;
        double area = 0.0;
        for (const SurfaceSample& s : samples) {
            const Vec3d areaVector(s.areaVector);
            sum += areaVector;
            volume += (Vec3d(s.position) + region.origin).dot(areaVector) / 3.0;
            area += areaVector.length();
        }
        const double side = size / region.voxelSize;
        EXPECT_NEAR(sum.length(), 0.0, 1e-6 * side * side) << size;
        EXPECT_NEAR(area, source.area() / 0.25, 1e-6 * side * side) << size;
        // Positions are floats, 100 voxels from the region's corner.
        EXPECT_NEAR(volume, source.volume() / 0.125, 1e-5 * side * side * (side + 1.0)) << size;
    }
}

TEST(MeshSource, ChoosesTheLowestRuleThatIsAccurateEnough) {
    const SurfaceQuadrature quadrature = testQuadrature();
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        const double leg = 0.999 * quadrature.triangleEdge[rule] / std::sqrt(2.0);
        const MeshSource source("tetrahedron", tetrahedron(Vec3d(0), leg));
        std::vector<SurfaceSample> samples;
        source.sampleElement(0, {1.0, Vec3d(-1), Vec3d(30)}, quadrature, samples);
        EXPECT_EQ(samples.size(), triangleRule(rule).size());
    }
}

TEST(MeshSource, SplitTrianglesIntegrateAWaveAsWellAsTheirRuleAllows) {
    // A wave of 10 voxels on a triangle of 40, against the same with triangles a quarter as large.
    const MeshSource source("tetrahedron", tetrahedron(Vec3d(0.3, 0.2, 0.1), 40.0));
    const SamplingRegion region{1.0, Vec3d(0), Vec3d(64)};
    SurfaceQuadrature coarse;
    coarse.triangleEdge.fill(0.0);
    coarse.triangleEdge.back() = 6.0;
    SurfaceQuadrature fine = coarse;
    fine.triangleEdge.back() = 1.5;
    const auto wave = [&](const SurfaceQuadrature& quadrature) {
        double sum = 0.0;
        for (const SurfaceSample& s : sampleAll(source, region, quadrature)) {
            sum += std::cos(0.6283 *
                            (0.5 * s.position.x() + 0.7 * s.position.y() + 0.51 * s.position.z())) *
                   s.areaVector.x();
        }
        return sum;
    };
    EXPECT_NEAR(wave(coarse), wave(fine), 1e-4);
}

TEST(MeshSource, EverySampleBelongsToExactlyOneOfNeighbouringRegions) {
    // Faces of the mesh lie on faces of the regions, at 8 and 16 voxels.
    const MeshSource source("tetrahedron", tetrahedron(Vec3d(0.8), 1.9));
    const SurfaceQuadrature quadrature = testQuadrature();
    const double voxelSize = 0.1;
    const SamplingRegion whole{voxelSize, Vec3d(0), Vec3d(32)};
    using Key = std::tuple<float, float, float, float, float, float>;
    const auto keys = [](const std::vector<SurfaceSample>& samples, const Vec3d& shift) {
        std::vector<Key> list;
        for (const SurfaceSample& s : samples) {
            const openvdb::Vec3f p(Vec3d(s.position) + shift);
            list.emplace_back(std::round(p.x() * 4096), std::round(p.y() * 4096),
                              std::round(p.z() * 4096), s.areaVector.x(), s.areaVector.y(),
                              s.areaVector.z());
        }
        return list;
    };

    std::vector<Key> parts;
    for (int i = 0; i < 64; ++i) {
        const SamplingRegion part{voxelSize, 8.0 * Vec3d(i / 16, i / 4 % 4, i % 4), Vec3d(8)};
        const auto samples = sampleAll(source, part, quadrature);
        for (const SurfaceSample& s : samples) {
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(s.position[axis], 0.0f);
                ASSERT_LE(s.position[axis], 8.0f);
            }
        }
        const std::vector<Key> list = keys(samples, part.origin);
        parts.insert(parts.end(), list.begin(), list.end());
    }
    std::vector<Key> all = keys(sampleAll(source, whole, quadrature), Vec3d(0));
    std::sort(all.begin(), all.end());
    std::sort(parts.begin(), parts.end());
    ASSERT_GT(all.size(), 1000u);
    ASSERT_EQ(parts.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        // Rounding to a float differs with the region, so compare up to one step of 1/4096.
        EXPECT_NEAR(std::get<0>(all[i]), std::get<0>(parts[i]), 1.0);
    }
}

TEST(MeshSource, SamplesOfAHugeTriangleStayFewInASmallRegion) {
    const MeshSource source("huge", tetrahedron(Vec3d(-1e6), 4e6));
    std::vector<SurfaceSample> samples;
    SurfaceQuadrature quadrature;
    quadrature.triangleEdge.fill(4.0);
    const Vec3d onFace(-1e6 + 5e5, -1e6 + 5e5, -1e6);
    source.sampleElement(0, {1.0, onFace - Vec3d(8), Vec3d(16)}, quadrature, samples);
    double area = 0.0;
    for (const SurfaceSample& s : samples) area += s.areaVector.length();
    EXPECT_NEAR(area, 256.0, 40.0);
    EXPECT_LT(samples.size(), 400u);
}

TEST(MeshSource, TrianglesWithoutAreaGiveNoSamples) {
    Mesh mesh;
    mesh.points = {Vec3d(0), Vec3d(1, 0, 0), Vec3d(2, 0, 0)};
    mesh.triangles = {Vec3I(0, 1, 2)};
    const MeshSource source("line", mesh);
    EXPECT_TRUE(sampleAll(source, {0.1, Vec3d(-50), Vec3d(100)}, testQuadrature()).empty());
}

TEST(MeshSource, RefusesAQuadratureWithoutLengths) {
    const MeshSource source("tetrahedron", tetrahedron(Vec3d(0), 1.0));
    std::vector<SurfaceSample> samples;
    EXPECT_THROW(source.sampleElement(0, {1.0, Vec3d(-1), Vec3d(4)}, {}, samples), Error);
}

}  // namespace
}  // namespace bandvox
