#include "source/test_patches.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/patch_solid.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

double largestDifference(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    double largest = 0;
    openvdb::CoordBBox box = a.evalActiveVoxelBoundingBox();
    box.expand(b.evalActiveVoxelBoundingBox());
    for (auto voxel = box.begin(); voxel; ++voxel) {
        largest = std::max(largest,
                           std::abs(double{a.tree().getValue(*voxel)} - b.tree().getValue(*voxel)));
    }
    return largest;
}

DensityOptions voxelsOf(double size) {
    DensityOptions options;
    options.voxelSize = size;
    return options;
}

TEST(PatchDensity, IsThatOfTheSphere) {
    const PatchSolid ball = makePatchSolid("ball", spherePatches(Vec3d(0), 1));
    const auto shape = makeShapeBoundary("shape:sphere");
    const DensityResult a = surfaceToDensity(*ball.source, voxelsOf(0.1));
    const DensityResult b = surfaceToDensity(*shape, voxelsOf(0.1));
    EXPECT_LT(a.metadata.closureError, 1e-4);
    EXPECT_LT(largestDifference(*a.grid, *b.grid), 1e-4);
}

TEST(PatchDensity, OfATorusHasItsVolume) {
    const PatchSolid torus = makePatchSolid("torus", torusPatches(0.7, 0.3));
    const double volume = 2 * std::numbers::pi * std::numbers::pi * 0.7 * 0.09;
    EXPECT_NEAR(torus.source->volume(), volume, 1e-10);
    const DensityResult density = surfaceToDensity(*torus.source, voxelsOf(0.06));
    EXPECT_LT(density.metadata.closureError, 1e-4);
    EXPECT_NEAR(density.metadata.gridVolume, volume, 1e-4 * volume);
}

TEST(PatchDensity, OfAUnionIsClosedWhereItsPartsMeet) {
    std::vector<BezierPatch> both = spherePatches(Vec3d(0), 1);
    const auto second = spherePatches(Vec3d(1.2, 0, 0), 1);
    both.insert(both.end(), second.begin(), second.end());
    const PatchSolid united = makePatchSolid("union", both);
    const DensityResult density = surfaceToDensity(*united.source, voxelsOf(0.25));
    EXPECT_LT(density.metadata.closureError, 2e-5);
    EXPECT_FALSE(density.overlaps);
    // Two balls less their lens, of two caps of height 0.4.
    const double volume = std::numbers::pi * (8.0 / 3 - 2 * 0.4 * 0.4 * (3 - 0.4) / 3);
    EXPECT_NEAR(density.metadata.gridVolume, volume, 1e-4 * volume);
}

}  // namespace
}  // namespace bandvox
