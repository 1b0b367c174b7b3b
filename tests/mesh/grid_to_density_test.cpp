#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/grid_to_density.h>
#include <bandvox/resample/resample_grid.h>

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <numbers>

namespace {

using openvdb::math::Transform;

constexpr double kRadius = 1;

openvdb::FloatGrid::Ptr sphere() {
    return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        float(kRadius), openvdb::Vec3f(0.2F, 0.1F, -0.3F), 0.05F);
}

TEST(GridToDensity, HoldsTheVolumeOfTheSolid) {
    const auto target = Transform::createLinearTransform(0.1);
    const bandvox::DensityResult made =
        bandvox::gridToDensity(sphere(), *target, {.source = "sphere"});
    const double volume = 4.0 / 3 * std::numbers::pi * kRadius * kRadius * kRadius;
    // Marching cubes cuts corners by an eighth of a voxel's square times the curvature, or less.
    EXPECT_NEAR(bandvox::densityIntegral(*made.grid), volume, 0.003 * volume);
    EXPECT_NEAR(made.metadata.gridVolume, made.metadata.sourceVolume, 1e-4 * volume);
    EXPECT_EQ(bandvox::sourceOf(*made.grid), "sphere");
    EXPECT_EQ(bandvox::densityMetadata(*made.grid)->gridVolume, made.metadata.gridVolume);
}

TEST(GridToDensity, ATurnedLatticeHoldsTheSame) {
    openvdb::Mat4d rows = openvdb::Mat4d::identity();
    rows.postScale(openvdb::Vec3d(0.1));
    rows.postRotate(openvdb::math::Z_AXIS, 0.6);
    rows.postTranslate(openvdb::Vec3d(0.03, 0.02, 0));
    const auto turned = Transform::createLinearTransform(rows);
    const auto grid = sphere();
    const auto made = bandvox::gridToDensity(grid, *turned, {});
    EXPECT_EQ(made.grid->transform(), *turned);
    const auto upright = bandvox::gridToDensity(grid, *Transform::createLinearTransform(0.1), {});
    EXPECT_NEAR(bandvox::densityIntegral(*made.grid), bandvox::densityIntegral(*upright.grid),
                1e-3);
    // Read on one lattice they are the same density, but for the corners that were cut.
    const auto back = bandvox::resampleGrid(made.grid, upright.grid->transform(),
                                            {.filter = {}, .tolerance = 1e-4});
    double largest = 0;
    for (auto voxel = upright.grid->cbeginValueOn(); voxel.test(); ++voxel) {
        if (!voxel.isVoxelValue()) continue;
        const float other = back.grid->tree().getValue(voxel.getCoord());
        largest = std::max(largest, std::abs(double(*voxel) - other));
    }
    EXPECT_LT(largest, 2e-3);
    EXPECT_GT(largest, 0);
}

TEST(GridToDensity, VoxelsThatAreNoCubesAreRefused) {
    auto target = Transform::createLinearTransform(0.1);
    target->preScale(openvdb::Vec3d(1, 2, 1));
    try {
        bandvox::gridToDensity(sphere(), *target, {});
        FAIL() << "expected an error";
    } catch (const bandvox::Error& error) {
        EXPECT_EQ(error.kind(), bandvox::ErrorKind::Usage);
    }
}

}  // namespace
