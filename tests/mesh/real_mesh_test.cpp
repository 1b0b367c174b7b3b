// Meshes as people have them, to densities and back, where there are some.

#include "mesh/mesh_checks.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace bandvox::mesh_test {
namespace {

using openvdb::Vec3d;

DensityResult densityOf(const Mesh& mesh, int resolution, const ExponentialFilter& filter = {}) {
    DensityOptions options;
    options.resolution = resolution;
    options.filter = filter;
    DensityResult result = surfaceToDensity(MeshSource("mesh", mesh), options);
    setDensityMetadata(*result.grid, result.metadata);
    return result;
}

// The mean distance from some of a mesh's points to another mesh, but for those near holes that
// were capped.
double meanDistance(const Mesh& from, const Mesh& to, const std::vector<CappedHole>& holes,
                    double margin) {
    constexpr std::size_t kPoints = 3000;
    const MeshDistance distance(to);
    double sum = 0;
    std::size_t count = 0;
    const std::size_t stride = std::max<std::size_t>(from.points.size() / kPoints, 1);
    for (std::size_t i = 0; i < from.points.size(); i += stride) {
        const Vec3d& point = from.points[i];
        const bool isNearCap = std::any_of(holes.begin(), holes.end(), [&](const auto& hole) {
            return (point - hole.center).length() < 0.5 * hole.perimeter + margin;
        });
        if (isNearCap) continue;
        sum += distance(point);
        ++count;
    }
    EXPECT_GT(count, kPoints / 2);
    return sum / static_cast<double>(count);
}

TEST(RealMesh, TheBunnyComesBack) {
    const char* data = std::getenv("BANDVOX_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "BANDVOX_TEST_DATA is not set";
    const std::filesystem::path path = std::filesystem::path(data) / "stanford-bunny.obj";
    const ClosedMesh source = closeMesh(readMesh(path).mesh);
    const auto& holes = source.report.holes;
    // The default filter is wider, and takes more of what is finer than a voxel away.
    struct Case {
        ExponentialFilter filter;
        double adaptivity, farthest;
    };
    const ExponentialFilter sharp{.order = 4, .cutoff = 0.25};
    for (const Case& c : {Case{{}, 0, 0.12}, Case{{}, 0.4, 0.12}, Case{sharp, 0, 0.1}}) {
        SCOPED_TRACE(testing::Message()
                     << "order " << c.filter.order << ", adaptivity " << c.adaptivity);
        const DensityResult density = densityOf(source.mesh, 256, c.filter);
        const double voxel = density.grid->voxelSize()[0];
        const MeshResult result = densityToMesh(density.grid, {.adaptivity = c.adaptivity});
        const Mesh& mesh = result.surface.mesh;
        EXPECT_EQ(flaw(mesh), "");
        EXPECT_EQ(eulerNumber(mesh), 2);
        EXPECT_EQ(pieces(mesh), 1u);
        EXPECT_EQ(meetings(mesh), 0u);
        const double forth = meanDistance(mesh, source.mesh, holes, 3 * voxel) / voxel;
        const double back = meanDistance(source.mesh, mesh, holes, 3 * voxel) / voxel;
        EXPECT_LT(forth, c.farthest);
        EXPECT_LT(back, c.farthest);
        // What is convex loses a little to the filter, what is hollow gains it.
        EXPECT_NEAR(result.volume / density.metadata.gridVolume, 1, 3e-3);
    }
}

TEST(RealMesh, FromMeshToMeshAndOn) {
    const char* data = std::getenv("BANDVOX_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "BANDVOX_TEST_DATA is not set";
    const ClosedMesh source = closeMesh(readMesh(std::filesystem::path(data) / "spot.obj").mesh);
    const MeshResult first = densityToMesh(densityOf(source.mesh, 96).grid);
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("bandvox_round_trip_" + std::to_string(getpid()) + ".ply");
    writeMesh(file, first.surface);
    const ClosedMesh again = closeMesh(readMesh(file).mesh);
    std::filesystem::remove(file);
    // Nothing has to be mended.
    EXPECT_TRUE(again.report.holes.empty());
    EXPECT_TRUE(again.report.warnings.empty());
    EXPECT_EQ(again.report.pointsWelded, 0u);
    EXPECT_EQ(again.report.degenerateTriangles, 0u);
    EXPECT_EQ(again.report.trianglesFlipped, 0u);
    EXPECT_EQ(again.report.nonManifoldEdges, 0u);
    // The density's integral is the volume of what it was made of.
    const DensityResult density = densityOf(again.mesh, 96);
    EXPECT_NEAR(density.metadata.gridVolume / first.volume, 1, 1e-5);
    const MeshResult second = densityToMesh(density.grid);
    EXPECT_EQ(flaw(second.surface.mesh), "");
    EXPECT_EQ(eulerNumber(second.surface.mesh), eulerNumber(first.surface.mesh));
    const double voxel = density.grid->voxelSize()[0];
    EXPECT_LT(meanDistance(second.surface.mesh, first.surface.mesh, {}, 0) / voxel, 0.15);
}

}  // namespace
}  // namespace bandvox::mesh_test
