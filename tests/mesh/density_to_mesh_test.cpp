#include "mesh/mesh_checks.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace bandvox::mesh_test {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3f;

DensityResult shapeDensity(const std::string& name, int resolution) {
    DensityOptions options;
    options.resolution = resolution;
    options.tolerance = 1e-5;
    DensityResult result = surfaceToDensity(*makeShapeBoundary("shape:" + name), options);
    setDensityMetadata(*result.grid, result.metadata);
    return result;
}

DensityMetadata filtered(double order, double cutoff) {
    DensityMetadata metadata;
    metadata.order = order;
    metadata.cutoff = cutoff;
    metadata.tolerance = 1e-5;
    return metadata;
}

/// The farthest point of a mesh from the surface, voxels, as value over slope tell; and the largest
/// angle between a normal and the gradient, radians. For densities.
struct Deviation {
    double distance = 0, angle = 0;
};

Deviation deviation(const SurfaceMesh& surface, const openvdb::FloatGrid& grid,
                    const Reconstruction& field, double iso) {
    Deviation worst;
    const auto probe = field.probe();
    for (std::size_t i = 0; i < surface.mesh.points.size(); ++i) {
        const DensityAt at = probe->evaluate(grid.worldToIndex(surface.mesh.points[i]));
        worst.distance = std::max(worst.distance, std::abs(at.value - iso) / at.gradient.length());
        const Vec3d outward = -grid.transform().baseMap()->applyIJT(at.gradient).unit();
        const double cosine = std::clamp(outward.dot(Vec3d(surface.normals[i])), -1.0, 1.0);
        worst.angle = std::max(worst.angle, std::acos(cosine));
    }
    return worst;
}

TEST(DensityToMesh, BallIsRound) {
    const DensityResult density = shapeDensity("sphere", 40);
    const MeshResult result = densityToMesh(density.grid);
    const Mesh& mesh = result.surface.mesh;
    EXPECT_EQ(flaw(mesh), "");
    EXPECT_EQ(eulerNumber(mesh), 2);
    EXPECT_EQ(result.iso, 0.5);
    EXPECT_TRUE(result.surface.colors.empty());
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_EQ(meetings(mesh), 0u);
    // The level 0.5 of a smoothed ball lies a little inside: by σ²/r, σ = 1/(√2 π k_c·2) voxels.
    const double voxel = density.grid->voxelSize()[0];
    const double sigma = 1 / (std::numbers::sqrt2 * std::numbers::pi * 0.16) * voxel;
    const double radius = 1 - sigma * sigma;
    double least = 2, most = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const double r = mesh.points[i].length();
        least = std::min(least, r);
        most = std::max(most, r);
        EXPECT_GT(Vec3d(result.surface.normals[i]).dot(mesh.points[i]) / r, 1 - 1e-5);
        EXPECT_NEAR(result.surface.normals[i].length(), 1, 1e-6);
    }
    EXPECT_LT(most - least, 1.5e-3 * voxel);
    EXPECT_NEAR(0.5 * (most + least), radius, 0.01 * voxel);
    // Triangles cut the ball's corners: by h²/8r on the average, h their size.
    EXPECT_NEAR(enclosedVolume(mesh) / (4.0 / 3 * std::numbers::pi * std::pow(most, 3)), 1, 2e-3);
    EXPECT_GT(enclosedVolume(mesh), 0);
}

TEST(DensityToMesh, ShapesAreClosedAndAccurate) {
    struct Shape {
        const char* name;
        long euler;
    };
    for (const Shape& shape : {Shape{"cube", 2}, Shape{"torus", 0}, Shape{"two-balls", 2},
                               Shape{"hyperboloid", 2}, Shape{"tree", 2}}) {
        SCOPED_TRACE(shape.name);
        const DensityResult density = shapeDensity(shape.name, 48);
        const MeshResult result = densityToMesh(density.grid);
        const Mesh& mesh = result.surface.mesh;
        EXPECT_EQ(flaw(mesh), "");
        EXPECT_EQ(meetings(mesh), 0u);
        EXPECT_EQ(eulerNumber(mesh), shape.euler);
        const auto field = makeBrickReconstruction(
            density.grid, {{density.metadata.order, density.metadata.cutoff}, 1.5e-5});
        const Deviation worst = deviation(result.surface, *density.grid, *field, 0.5);
        EXPECT_LT(worst.distance, 1e-3);
        EXPECT_LT(worst.angle, 1e-2);
    }
}

/// A smooth solid from the distance to its surface, negative inside, voxels: 1 inside, 0.5 on the
/// surface.
double smooth(double distance) {
    return 1 / (1 + std::exp(2 * distance));
}

void expectSound(const MeshResult& result) {
    EXPECT_EQ(flaw(result.surface.mesh), "");
    EXPECT_GT(result.volume, 0);
    EXPECT_NEAR(result.volume, enclosedVolume(result.surface.mesh), 1e-9 * result.volume);
    for (const Vec3f& normal : result.surface.normals) ASSERT_NEAR(normal.length(), 1, 1e-5);
}

TEST(DensityToMesh, RandomWavesAreManifoldWhateverTheCells) {
    std::size_t ambiguous = 0;
    for (const double highest : {0.2, 0.45, 0.8}) {
        for (unsigned seed = 1; seed <= 4; ++seed) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", up to " << highest);
            const auto grid = sampled(20, RandomWaves(seed, highest, 12));
            MeshOptions options;
            options.iso = 0.1;
            const MeshResult plain = densityToMesh(grid, options);
            expectSound(plain);
            ambiguous += plain.ambiguousFaces;
            const auto spline = makeSplineReconstruction(grid);
            EXPECT_LT(deviation(plain.surface, *grid, *spline, 0.1).distance, 1e-3);
            if (highest > 0.45) continue;
            // What is well sampled does not pass through itself either.
            if (highest < 0.3) {
                EXPECT_EQ(meetings(plain.surface.mesh), 0u);
            }
            setDensityMetadata(*grid, filtered(2, 0.16));
            expectSound(densityToMesh(grid, options));
        }
    }
    EXPECT_GT(ambiguous, 10000u);
}

TEST(DensityToMesh, NodesOnTheSurfaceAreNoExceptions) {
    // Values are below, at and above the iso-value by chance, and many at it.
    std::mt19937 random(7);
    const auto grid = sampled(10, [&](const Vec3d&) { return 0.5 * double(random() % 3); });
    MeshResult result = densityToMesh(grid);
    expectSound(result);
    EXPECT_GT(result.ambiguousFaces, 1000u);
    // In single precision points stay apart, too.
    std::vector<Vec3f> points;
    for (const Vec3d& p : result.surface.mesh.points) points.emplace_back(p);
    std::sort(points.begin(), points.end());
    EXPECT_EQ(std::adjacent_find(points.begin(), points.end()), points.end());
}

TEST(DensityToMesh, TouchingBalls) {
    // They touch at a node, in the middle of an edge, and in the middle of a cell.
    for (const Vec3d& touch : {Vec3d(0.0), Vec3d(0.5, 0, 0), Vec3d(0.5), Vec3d(0.3, 0.1, 0.4)}) {
        for (const Vec3d& direction : {Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(1, 1, 1)}) {
            const Vec3d center = 6 * direction.unit();
            const auto grid = sampled(14, [&](const Vec3d& x) {
                return smooth(
                    std::min((x - touch - center).length(), (x - touch + center).length()) - 6);
            });
            const MeshResult result = densityToMesh(grid);
            expectSound(result);
            EXPECT_LE(pieces(result.surface.mesh), 2u);
            EXPECT_NEAR(result.volume, 2 * 4.0 / 3 * std::numbers::pi * 216, 40);
        }
    }
}

TEST(DensityToMesh, ThinSheetsAndGaps) {
    for (const bool isGap : {false, true}) {
        for (const Vec3d& across : {Vec3d(1, 0, 0), Vec3d(1, 2, 0).unit(), Vec3d(1, 2, 3).unit()}) {
            for (const double thickness : {0.3, 1.0, 2.0}) {
                const auto grid = sampled(14, [&](const Vec3d& x) {
                    const double sheet = std::abs(x.dot(across) - 0.25) - 0.5 * thickness;
                    const double ball = x.length() - 10;
                    return smooth(std::max(ball, isGap ? -sheet : sheet));
                });
                SCOPED_TRACE(testing::Message() << thickness << " across " << across);
                expectSound(densityToMesh(grid, {.iso = 0.3}));
            }
        }
    }
}

TEST(DensityToMesh, LoneVoxelsAreOctahedra) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().setValue({-1, 7, 8}, 1);
    grid->tree().setValue({3, 8, 7}, 1);
    const MeshResult result = densityToMesh(grid);
    expectSound(result);
    EXPECT_EQ(result.surface.mesh.points.size(), 12u);
    EXPECT_EQ(result.surface.mesh.triangles.size(), 16u);
    EXPECT_EQ(pieces(result.surface.mesh), 2u);
    EXPECT_EQ(result.cells, 16u);
}

TEST(DensityToMesh, TilesEndLikeVoxels) {
    // Tiles alone; tiles beside leaves; the same as leaves; across the tree's largest nodes.
    const openvdb::CoordBBox whole(openvdb::Coord(-128, 0, 0), openvdb::Coord(127, 15, 7));
    std::vector<MeshResult> results;
    for (const int kind : {0, 1, 2}) {
        auto grid = openvdb::FloatGrid::create(0);
        grid->fill(whole, 1.0F, kind != 1);
        if (kind == 1) grid->tree().setValue({3, 4, 5}, 1.0F);
        if (kind == 2) grid->tree().voxelizeActiveTiles();
        results.push_back(densityToMesh(grid));
        expectSound(results.back());
        EXPECT_EQ(eulerNumber(results.back().surface.mesh), 2);
        EXPECT_EQ(results[0].surface.mesh.points, results.back().surface.mesh.points);
        EXPECT_EQ(results[0].surface.mesh.triangles, results.back().surface.mesh.triangles);
    }
    // Half way between the last voxels inside and the first outside, but for the corners.
    EXPECT_NEAR(results[0].volume, 256 * 16 * 8, 0.03 * 256 * 16 * 8);
    // A tile of a larger node, alone.
    auto large = openvdb::FloatGrid::create(0);
    large->tree().addTile(2, openvdb::Coord(0), 1.0F, false);
    large->tree().setValueOn({300, 300, 300}, 1.0F);
    const MeshResult result = densityToMesh(large);
    expectSound(result);
    EXPECT_EQ(pieces(result.surface.mesh), 2u);
    EXPECT_NEAR(result.volume, 128 * 128 * 128, 0.01 * 128 * 128 * 128);
}

TEST(DensityToMesh, TheEndOfTheGridCutsTheSurface) {
    // Half a ball: what is not in the grid is outside.
    const auto grid =
        sampled(12, [](const Vec3d& x) { return x[0] >= 0 ? smooth(x.length() - 10) : 0; });
    const MeshResult result = densityToMesh(grid);
    expectSound(result);
    EXPECT_EQ(eulerNumber(result.surface.mesh), 2);
    const double half = 2.0 / 3 * std::numbers::pi * 1000;
    EXPECT_NEAR(result.volume, half + 0.5 * std::numbers::pi * 100, 0.02 * half);
}

TEST(DensityToMesh, LevelSetsAreNegativeInside) {
    const float voxel = 0.1F;
    const auto grid =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(4.0F, {1, 2, 3}, voxel);
    for (const double distance : {0.0, -0.15, 0.2}) {
        MeshOptions options;
        options.iso = distance;
        const MeshResult result = densityToMesh(grid, distance == 0 ? MeshOptions() : options);
        expectSound(result);
        EXPECT_EQ(result.iso, distance);
        EXPECT_EQ(eulerNumber(result.surface.mesh), 2);
        for (std::size_t i = 0; i < result.surface.mesh.points.size(); ++i) {
            const Vec3d from = result.surface.mesh.points[i] - Vec3d(1, 2, 3);
            // Distances end 3 voxels from 0, which the spline feels a little.
            ASSERT_NEAR(from.length(), 4 + distance, (distance == 0 ? 3e-3 : 3e-2) * voxel);
            ASSERT_GT(Vec3d(result.surface.normals[i]).dot(from.unit()), 0.996);
        }
    }
}

TEST(DensityToMesh, AnyLinearTransform) {
    openvdb::Mat4d turned = openvdb::Mat4d::identity();
    turned.preScale(Vec3d(1, 1, 3));
    turned.postRotate(openvdb::math::X_AXIS, 0.7);
    turned.postRotate(openvdb::math::Z_AXIS, -0.4);
    turned.postTranslate(Vec3d(5, -6, 7));
    openvdb::Mat4d mirrored = turned;
    mirrored.preScale(Vec3d(-1, 1, 1));
    for (const openvdb::Mat4d& matrix : {turned, mirrored}) {
        const auto transform = openvdb::math::Transform::createLinearTransform(matrix);
        // A ball in world space, whose voxels are boxes.
        const double radius = 15;
        const auto grid = sampled(18, [&](const Vec3d& x) {
            return smooth(0.4 * ((transform->indexToWorld(x) - Vec3d(5, -6, 7)).length() - radius));
        });
        grid->setTransform(transform);
        const MeshResult result = densityToMesh(grid);
        expectSound(result);
        EXPECT_EQ(meetings(result.surface.mesh), 0u);
        EXPECT_NEAR(result.volume / (4.0 / 3 * std::numbers::pi * std::pow(radius, 3)), 1, 0.02);
        const auto spline = makeSplineReconstruction(grid);
        const Deviation worst = deviation(result.surface, *grid, *spline, 0.5);
        EXPECT_LT(worst.distance, 1e-3);
        EXPECT_LT(worst.angle, 1e-2);
        for (std::size_t i = 0; i < result.surface.mesh.points.size(); ++i) {
            const Vec3d from = result.surface.mesh.points[i] - Vec3d(5, -6, 7);
            ASSERT_GT(Vec3d(result.surface.normals[i]).dot(from.unit()), 0.98);
        }
    }
}

TEST(DensityToMesh, IsTheSameForAnyNumberOfThreads) {
    const auto grid = sampled(36, RandomWaves(3, 0.2, 14));
    MeshOptions options;
    options.iso = 0.2;
    options.adaptivity = 0.3;
    std::vector<MeshResult> results;
    for (const int threads : {1, 5}) {
        const ThreadLimit limit(threads);
        results.push_back(densityToMesh(grid, options));
    }
    EXPECT_EQ(results[0].surface.mesh.points, results[1].surface.mesh.points);
    EXPECT_EQ(results[0].surface.mesh.triangles, results[1].surface.mesh.triangles);
    EXPECT_EQ(results[0].surface.normals, results[1].surface.normals);
}

TEST(DensityToMesh, ColorsAreThoseOfTheGrid) {
    const auto grid = sampled(12, [](const Vec3d& x) { return smooth(x.length() - 8); });
    auto colors = openvdb::Vec3SGrid::create(Vec3f(0.25F));
    // On a lattice of its own, linear along x, and missing on one side.
    colors->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    auto accessor = colors->getAccessor();
    for (int x = -24; x <= 24; ++x) {
        for (int y = -24; y <= 24; ++y) {
            for (int z = -24; z <= 8; ++z) {
                accessor.setValue({x, y, z}, Vec3f(static_cast<float>(x) / 48 + 0.5F, 1, 0));
            }
        }
    }
    MeshOptions options;
    options.colors = colors;
    const MeshResult result = densityToMesh(grid, options);
    ASSERT_EQ(result.surface.colors.size(), result.surface.mesh.points.size());
    std::size_t missing = 0;
    for (std::size_t i = 0; i < result.surface.colors.size(); ++i) {
        const Vec3d& place = result.surface.mesh.points[i];
        const Vec3f& color = result.surface.colors[i];
        if (place[2] >= 4.5) {
            EXPECT_EQ(color, Vec3f(0.25F));
            ++missing;
        } else {
            EXPECT_NEAR(color[0], place[0] / 24 + 0.5, 1e-5);
            EXPECT_EQ(color[2], 0);
        }
    }
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find(std::to_string(missing) + " points"), std::string::npos);
}

TEST(DensityToMesh, RefusesWhatHasNoSurface) {
    const auto ball = sampled(6, [](const Vec3d& x) { return 0.9 * smooth(x.length() - 4); });
    const auto kindWith = [&](const openvdb::FloatGrid::Ptr& grid, const MeshOptions& options) {
        return kindOf([&] { densityToMesh(grid, options); });
    };
    EXPECT_EQ(kindWith(nullptr, {}), ErrorKind::Usage);
    EXPECT_EQ(kindWith(ball, {.iso = 0.95}), ErrorKind::Result);
    EXPECT_EQ(kindWith(ball, {.iso = 0.0}), ErrorKind::Usage);
    EXPECT_EQ(kindWith(ball, {.adaptivity = 1.01}), ErrorKind::Usage);
    EXPECT_EQ(kindWith(ball, {.adaptivity = -0.1}), ErrorKind::Usage);
    EXPECT_EQ(kindWith(ball, {.tolerance = 1e-7}), ErrorKind::Usage);
    EXPECT_EQ(kindWith(openvdb::FloatGrid::create(0), {}), ErrorKind::Input);
    auto broken = ball->deepCopy();
    broken->tree().setValue({1, 1, 1}, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(kindWith(broken, {}), ErrorKind::Input);
    auto bent = ball->deepCopy();
    bent->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(-6.0), Vec3d(6.0)), 0.5, 10));
    EXPECT_EQ(kindWith(bent, {}), ErrorKind::Input);
    const auto levelSet =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(4.0F, {0, 0, 0}, 0.5F);
    EXPECT_EQ(kindWith(levelSet, {.iso = 2.0}), ErrorKind::Usage);
    EXPECT_EQ(kindWith(levelSet, {.iso = -4.5}), ErrorKind::Result);
}

TEST(DensityToMesh, StopsWhenAsked) {
    class Stop final : public Progress {
      public:
        bool interrupted() const override { return true; }
    };
    Stop stop;
    const auto ball = sampled(6, [](const Vec3d& x) { return smooth(x.length() - 4); });
    EXPECT_THROW(densityToMesh(ball, {}, stop), Error);
}

}  // namespace
}  // namespace bandvox::mesh_test
