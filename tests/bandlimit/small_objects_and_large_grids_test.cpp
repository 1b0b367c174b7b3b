// What surfaceToDensity does at the ends of its range: objects of few voxels, and of many.

#include "allocation_meter.h"
#include "source/test_meshes.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/bandlimit/surface_to_vdb.h>
#include <bandvox/core/error.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

namespace bandvox {
namespace {

using openvdb::Vec3d;

MeshSource tetrahedron(double size) {
    Mesh mesh;
    mesh.points = {Vec3d(0), Vec3d(size, 0, 0), Vec3d(0, size, 0), Vec3d(0, 0, size)};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return MeshSource("tetrahedron", mesh);
}

std::size_t peakOfCube(int resolution) {
    const auto cube = makeShapeBoundary("shape:cube");
    DensityOptions options;
    options.resolution = resolution;
    const AllocationMeter meter;
    surfaceToDensity(*cube, options);
    return meter.peak();
}

// A flat wheel with teeth that are much finer than a voxel, and no wider than they are high.
MeshSource wheel(unsigned teeth, double height) {
    Mesh mesh;
    mesh.points = {Vec3d(0), Vec3d(0, 0, height)};
    for (unsigned i = 0; i < 2 * teeth; ++i) {
        const double angle = std::numbers::pi * i / teeth;
        const double radius = i % 2 == 0 ? 1 : 1.3;
        const Vec3d point(radius * std::cos(angle), radius * std::sin(angle), 0);
        mesh.points.push_back(point);
        mesh.points.push_back(point + Vec3d(0, 0, height));
    }
    const auto bottom = [teeth](unsigned i) { return 2 + 2 * (i % (2 * teeth)); };
    for (unsigned i = 0; i < 2 * teeth; ++i) {
        const unsigned a = bottom(i), b = bottom(i + 1);
        mesh.triangles.emplace_back(a, b, b + 1);
        mesh.triangles.emplace_back(a, b + 1, a + 1);
        if (i % 2 != 0) continue;
        // A tooth, and its part of the disc.
        const unsigned c = bottom(i + 2);
        mesh.triangles.emplace_back(a, c, b);
        mesh.triangles.emplace_back(a + 1, b + 1, c + 1);
        mesh.triangles.emplace_back(0, c, a);
        mesh.triangles.emplace_back(1, a + 1, c + 1);
    }
    return MeshSource("wheel", mesh);
}

// The quadrature errors of its teeth are all of one sign.
TEST(SmallObjects, TeethFinerThanTheLatticeKeepToTheTolerance) {
    const MeshSource source = wheel(5000, 0.6);
    for (const double resolution : {24, 30, 36}) {
        DensityOptions options;
        options.voxelSize = 2.6 / resolution;
        const DensityResult result = surfaceToDensity(source, options);
        EXPECT_LE(result.metadata.closureError, options.tolerance);
        EXPECT_NEAR(result.metadata.gridVolume / source.volume(), 1, 1e-4);
    }
}

TEST(SmallObjects, AFinerQuadratureIsTakenWithinALimitOfMemoryToo) {
    const MeshSource source = wheel(5000, 0.6);
    const VdbTarget target{.file = "unused.vdb", .write = {}, .memoryLimit = std::int64_t(1) << 40};
    int refinements = 0;
    for (const double resolution : {24, 30, 36}) {
        DensityOptions options;
        options.voxelSize = 2.6 / resolution;
        const DensityResult whole = surfaceToDensity(source, options);
        const DensityResult made = surfaceToSpooledDensity(source, options, target);
        EXPECT_EQ(made.refinements, whole.refinements);
        EXPECT_EQ(made.surfaceSamples, whole.surfaceSamples);
        EXPECT_EQ(made.metadata.closureError, whole.metadata.closureError);
        EXPECT_EQ(made.metadata.gridVolume, whole.metadata.gridVolume);
        refinements += made.refinements;
    }
    EXPECT_GT(refinements, 0);
}

// Twice the resolution is four times the surface; a part does not grow, and borders vary.
// A tile sees millions of samples, each far less than the rounding of what they add up to.
TEST(SmallObjects, AMeshFarFinerThanTheLatticeKeepsToTheTolerance) {
    const Mesh ball = test::sphere(Vec3d(0.01, 0.02, 0.03), 1, 500, 1000);
    const MeshSource source("ball", ball);
    DensityOptions options;
    options.voxelSize = 2.0 / 48;
    const DensityResult result = surfaceToDensity(source, options);
    EXPECT_GT(result.surfaceSamples, 1000000);
    EXPECT_LE(result.metadata.closureError, 5e-5);
    EXPECT_NEAR(result.metadata.gridVolume / source.volume(), 1, 2e-5);
}

TEST(LargeGrids, MemoryFollowsTheSurface) {
    const std::size_t small = peakOfCube(150);
    const std::size_t large = peakOfCube(300);
    EXPECT_LE(static_cast<double>(large), 5.5 * static_cast<double>(small));
}

TEST(LargeGrids, InteriorIsTiles) {
    const auto cube = makeShapeBoundary("shape:cube");
    DensityOptions options;
    options.resolution = 500;
    const DensityResult result = surfaceToDensity(*cube, options);
    const openvdb::FloatTree& tree = result.grid->tree();
    // The cube is [-1, 1]³, so index 0 is its middle.
    EXPECT_EQ(tree.getValueDepth(openvdb::Coord(0)), 1);  // one of 128³ in the node above
    EXPECT_EQ(tree.getValue(openvdb::Coord(0)), 1.0F);
    EXPECT_TRUE(tree.isValueOn(openvdb::Coord(0)));
    for (const int x : {-243, -200, -130, -7, 60, 129, 243}) {
        EXPECT_EQ(tree.getValue(openvdb::Coord(x, 11, -100)), 1.0F) << x;
        EXPECT_EQ(tree.getValue(openvdb::Coord(5, x, 200)), 1.0F) << x;
        EXPECT_EQ(tree.getValue(openvdb::Coord(-30, 40, x)), 1.0F) << x;
    }
    EXPECT_NEAR(result.metadata.gridVolume, 8, 8e-6);
}

TEST(SmallObjects, LostVolumeIsAWarning) {
    DensityOptions options;
    options.resolution = 1;
    const DensityResult lost = surfaceToDensity(tetrahedron(1), options);
    ASSERT_FALSE(lost.warnings.empty());
    EXPECT_NE(lost.warnings.back().find("differs from the volume"), std::string::npos);
    options.resolution = 64;
    EXPECT_TRUE(surfaceToDensity(tetrahedron(1), options).warnings.empty());
}

TEST(SmallObjects, VoxelsBelowOpenVdbsSmallestAreRefused) {
    const auto kindOf = [](double size, const DensityOptions& options) {
        try {
            surfaceToDensity(tetrahedron(size), options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    DensityOptions options;
    options.resolution = 32;
    EXPECT_EQ(kindOf(1e-20, options), ErrorKind::Input);
    options.voxelSize = 1e-20;
    EXPECT_EQ(kindOf(1e-19, options), ErrorKind::Usage);
    // A voxel that is only too small for the object takes more memory than there is.
    options.voxelSize = 1.45e-5;
    EXPECT_EQ(kindOf(10, options), ErrorKind::Memory);
    EXPECT_EQ(kindOf(1e-3, options), ErrorKind::Runtime) << "it is made";
    options.voxelSize = 1.44e-5;
    EXPECT_EQ(kindOf(1e-3, options), ErrorKind::Usage);
}

}  // namespace
}  // namespace bandvox
