#include "bandlimit/grid_difference.h"
#include "source/soup_meshes.h"

#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/mesh_source.h>

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox {
namespace {

using openvdb::Vec3d;

SoupDensityOptions voxelsOf(double size, int rows = 4) {
    SoupDensityOptions options;
    options.density.voxelSize = size;
    options.rowsPerVoxel = rows;
    return options;
}

openvdb::FloatGrid::Ptr exact(const Mesh& mesh, double voxelSize) {
    DensityOptions options;
    options.voxelSize = voxelSize;
    return surfaceToDensity(MeshSource("mesh", mesh), options).grid;
}

// Closed meshes, taken as soups: what the exact route makes of them is the truth.
std::vector<Mesh> solids() {
    Mesh hollow = test::askew(test::cube(Vec3d(-1.0), 2));
    test::append(hollow, test::reversed(test::askew(test::cube(Vec3d(-0.6), 1.2))));
    return {test::cube(Vec3d(-1.03, -0.97, -1.01), 2), test::askew(test::cube(Vec3d(-1.0), 2)),
            test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 60, 90), hollow};
}

TEST(SoupToDensity, StaysWithinTheErrorThatItStates) {
    for (const Mesh& mesh : solids()) {
        for (const double voxelSize : {0.11, 0.043}) {
            const openvdb::FloatGrid::Ptr truth = exact(mesh, voxelSize);
            double previous = 1;
            for (const int rows : {2, 4, 8}) {
                const DensityResult result =
                    soupToDensity({"soup", mesh, {}}, voxelsOf(voxelSize, rows));
                const double error = largestDifference(*result.grid, *truth);
                EXPECT_LE(error, result.metadata.samplingError) << rows << " " << voxelSize;
                EXPECT_LE(error, 1.2 * previous) << rows << " " << voxelSize;
                EXPECT_LE(result.metadata.closureError, 1e-4);
                EXPECT_EQ(result.metadata.route, "winding");
                EXPECT_EQ(result.metadata.oversampling, rows);
                previous = error;
            }
            EXPECT_LT(previous, 0.012) << voxelSize;
        }
    }
}

TEST(SoupToDensity, PanelsMakeABox) {
    const openvdb::FloatGrid::Ptr truth = exact(test::askew(test::cube(Vec3d(-1.0), 2)), 0.05);
    const DensityResult result =
        soupToDensity({"panels", test::askew(test::panels(0.002)), {}}, voxelsOf(0.05));
    EXPECT_LT(largestDifference(*result.grid, *truth), 0.03);
    EXPECT_NEAR(result.metadata.gridVolume, 8, 0.01);
    EXPECT_NEAR(result.metadata.sourceVolume, result.metadata.gridVolume, 1e-3);
    EXPECT_GE(result.minimum, -1e-3);
    EXPECT_LE(result.maximum, 1 + 1e-3);
}

TEST(SoupToDensity, ShredsMakeWhatTheyWereCutFrom) {
    const Mesh ball = test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 60, 90);
    const openvdb::FloatGrid::Ptr truth = exact(ball, 0.05);
    const DensityResult shreds =
        soupToDensity({"shreds", test::shredded(ball, 0.1), {}}, voxelsOf(0.05));
    EXPECT_LT(largestDifference(*shreds.grid, *truth), 0.03);
    const DensityResult rest =
        soupToDensity({"rest", test::thinned(ball, 0.3, 5), {}}, voxelsOf(0.05));
    EXPECT_LT(largestDifference(*rest.grid, *truth), 0.35);
    EXPECT_NEAR(rest.metadata.gridVolume, densityIntegral(*truth), 0.03);
}

TEST(SoupToDensity, UnitesTheSoupWithASolid) {
    // Panels around [-1, 1]³, and a cube that shares an eighth of that.
    const Mesh solid = test::cube(Vec3d(0.0), 2);
    const DensityResult both =
        soupToDensity({"both", test::panels(0.002), solid}, voxelsOf(0.05, 8));
    EXPECT_NEAR(both.metadata.gridVolume, 15, 0.02);
    EXPECT_LE(both.maximum, 1.02);
    const auto values = both.grid->getConstAccessor();
    EXPECT_NEAR(values.getValue({10, 10, 10}), 1, 1e-3);
    EXPECT_NEAR(values.getValue({-10, -10, -10}), 1, 1e-3);
    EXPECT_NEAR(values.getValue({-30, 30, 10}), 0, 1e-3);
    // Where the soup ends within the solid nothing is to be seen.
    for (int i = -12; i < 30; ++i) EXPECT_NEAR(values.getValue({i, 10, 11}), 1, 0.02) << i;
}

TEST(SoupToDensity, MovesWithTheMesh) {
    const Mesh mesh = test::askew(test::panels(0.05));
    const DensityResult here = soupToDensity({"soup", mesh, {}}, voxelsOf(0.125));
    Mesh moved = mesh;
    for (Vec3d& p : moved.points) p += 0.125 * Vec3d(8, -16, 24);
    const DensityResult there = soupToDensity({"soup", moved, {}}, voxelsOf(0.125));
    const auto values = there.grid->getConstAccessor();
    for (auto value = here.grid->cbeginValueOn(); value; ++value) {
        ASSERT_NEAR(*value, values.getValue(value.getCoord() + openvdb::Coord(8, -16, 24)), 1e-3);
    }
}

TEST(SoupToDensity, WarnsOfALargeSamplingError) {
    for (const int rows : {1, 3}) {
        SoupDensityOptions options = voxelsOf(0.1, rows);
        EXPECT_GT(soupToDensity({"soup", test::panels(0.05), {}}, options).metadata.samplingError,
                  0);
        options.samplingTolerance = 1e-6;
        const DensityResult warned = soupToDensity({"soup", test::panels(0.05), {}}, options);
        EXPECT_NE(warned.warnings.at(0).find("above the tolerance"), std::string::npos);
    }
}

TEST(SoupToDensity, SaysWhatCannotBe) {
    const auto kind = [](const Mesh& mesh, const SoupDensityOptions& options) {
        try {
            soupToDensity({"soup", mesh, {}}, options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    Mesh sheet = test::panels(0.1);
    sheet.triangles.resize(2);
    EXPECT_EQ(kind(sheet, voxelsOf(0.1)), ErrorKind::Result);
    EXPECT_EQ(kind(test::panels(0.1), voxelsOf(0.1, 0)), ErrorKind::Usage);
    EXPECT_EQ(kind(test::panels(0.1), voxelsOf(-1)), ErrorKind::Usage);
    EXPECT_EQ(kind(test::panels(0.1), voxelsOf(2e-5)), ErrorKind::Memory);
    SoupDensityOptions options = voxelsOf(0.1);
    options.samplingTolerance = std::nan("");
    EXPECT_EQ(kind(test::panels(0.1), options), ErrorKind::Usage);
}

TEST(SoupToDensity, IsTheSameForAnyNumberOfThreads) {
    const Mesh mesh = test::shredded(test::sphere(Vec3d(0.0), 1, 30, 40), 0.2);
    const auto convert = [&](int threads) {
        const ThreadLimit limit(threads);
        return soupToDensity({"soup", mesh, {}}, voxelsOf(0.05)).grid;
    };
    EXPECT_EQ(largestDifference(*convert(1), *convert(3)), 0);
}

TEST(GridDifference, LooksAtAllOfBoth) {
    openvdb::FloatGrid a(0.0F), b(0.0F);
    EXPECT_EQ(largestDifference(a, b), 0);
    a.tree().setValue({1, 2, 3}, 0.5F);
    EXPECT_EQ(largestDifference(a, b), 0.5);
    EXPECT_EQ(largestDifference(b, a), 0.5);
    b.tree().addTile(1, {80, 0, 0}, -2.0F, true);
    EXPECT_EQ(largestDifference(a, b), 2);
    a.tree().addTile(2, {0, 0, 0}, -2.0F, true);
    a.tree().setValue({1, 2, 3}, 0.5F);
    b.tree().setValue({1, 2, 3}, 3.5F);
    EXPECT_EQ(largestDifference(a, b), 3);
    EXPECT_EQ(largestDifference(b, a), 3);
}

}  // namespace
}  // namespace bandvox
