#include "voxelize/voxel_meshes.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/voxelize/field_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels.h>
#include <bandvox/voxelize/voxel_source.h>

#include <gtest/gtest.h>

#include <random>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

VoxelResult ball(double radius, const VoxelOptions& options) {
    return meshToVoxels(MeshSource("ball.obj", test::sphere(Vec3d(0.3, -1.2, 2.1), radius, 40, 60)),
                        options);
}

ErrorKind kindOfFailure(const openvdb::FloatGrid::ConstPtr& grid) {
    try {
        const VoxelSource source("a.vdb", grid);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "it was taken";
    return ErrorKind::Runtime;
}

TEST(VoxelSource, GivesEachVoxelsValueAllOverItsCube) {
    const VoxelResult voxels = ball(4, {.voxelSize = 0.3, .fraction = true});
    const VoxelSource source("ball.vdb", voxels.grid);
    EXPECT_EQ(source.name(), "ball.vdb");
    const CoordBBox active = voxels.grid->evalActiveVoxelBoundingBox();
    EXPECT_TRUE(source.bounds().min().eq(0.3 * (active.min().asVec3d() - Vec3d(0.5)), 1e-12));
    EXPECT_TRUE(source.bounds().max().eq(0.3 * (active.max().asVec3d() + Vec3d(0.5)), 1e-12));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> within(-0.4999, 0.4999);
    for (auto voxel = CoordBBox(active.min().offsetBy(-2), active.max().offsetBy(2)).begin(); voxel;
         ++voxel) {
        const Vec3d place(within(random), within(random), within(random));
        float value = -1;
        source.sampleRow(0.3 * ((*voxel).asVec3d() + place), Vec3d(0.0), {&value, 1});
        ASSERT_EQ(value, voxels.grid->tree().getValue(*voxel)) << *voxel;
    }
    // Along a slanted row.
    std::vector<float> row(50);
    const Vec3d start(-4, -5, -2), step(0.13, 0.17, 0.19);
    source.sampleRow(start, step, row);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const Vec3d index = (start + static_cast<double>(i) * step) / 0.3;
        EXPECT_EQ(row[i], voxels.grid->tree().getValue(Coord::round(index))) << i;
    }
}

TEST(VoxelSource, KnowsWhereItIsConstant) {
    const VoxelResult voxels = ball(60, {.voxelSize = 1, .fraction = true});
    const VoxelSource source("ball.vdb", voxels.grid);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> corner(-70, 60), side(0, 25);
    int known = 0;
    for (int round = 0; round < 2000; ++round) {
        const Vec3d low(corner(random), corner(random), corner(random));
        const Vec3d high = low + Vec3d(side(random), side(random), side(random));
        const auto constant = source.constantIn({low, high});
        bool isConstant = true;
        const Coord first = Coord::round(low);
        const float value = voxels.grid->tree().getValue(first);
        for (auto voxel = CoordBBox(first, Coord::round(high)).begin(); voxel; ++voxel) {
            isConstant = isConstant && voxels.grid->tree().getValue(*voxel) == value;
        }
        ASSERT_EQ(constant.has_value(), isConstant) << low << high;
        EXPECT_EQ(constant.value_or(value), value);
        known += constant.has_value();
    }
    EXPECT_GT(known, 300);
    EXPECT_EQ(source.constantIn({Vec3d(-30), Vec3d(30)}), 1.0F);
    EXPECT_EQ(source.constantIn({Vec3d(2e9), Vec3d(1e30)}), 0.0F);
    EXPECT_FALSE(source.constantIn({Vec3d(-1e30), Vec3d(1e30)}));
    EXPECT_FALSE(source.constantIn(BBoxd()));
}

TEST(VoxelSource, MakesTheSameVoxelsAgain) {
    for (const VoxelOptions& options :
         {VoxelOptions{.voxelSize = 0.35}, VoxelOptions{.voxelSize = 0.35, .threshold = 3},
          VoxelOptions{.voxelSize = 0.35, .axis = ScanAxis::Z}}) {
        const VoxelResult voxels = ball(9, options);
        test::expectSameVoxels(voxels, fieldToVoxels(VoxelSource("v.vdb", voxels.grid), options));
    }
}

TEST(VoxelSource, KeepsItsVolumeAsADensity) {
    const VoxelResult voxels = ball(9, {.voxelSize = 1, .fraction = true});
    FieldDensityOptions options;
    options.density.voxelSize = 1;
    options.oversample = 4;
    const DensityResult density = fieldToDensity(VoxelSource("v.vdb", voxels.grid), options);
    EXPECT_NEAR(densityIntegral(*density.grid), voxels.volume, 0.01 * voxels.volume);
}

TEST(VoxelSource, TakesAMask) {
    const VoxelResult voxels = ball(9, {.voxelSize = 0.5});
    const auto mask = voxelsToMask(*voxels.grid);
    EXPECT_EQ(mask->getName(), "mask");
    EXPECT_EQ(mask->metaValue<std::string>("bandvox_source"), "ball.obj");
    EXPECT_EQ(mask->voxelSize(), voxels.grid->voxelSize());
    EXPECT_EQ(static_cast<std::int64_t>(mask->activeVoxelCount()), voxels.voxels);
    EXPECT_FALSE(mask->background());
    for (auto value = mask->cbeginValueOn(); value; ++value) EXPECT_TRUE(*value);
    const auto back = maskToVoxels(*mask);
    EXPECT_TRUE(back->tree().hasSameTopology(voxels.grid->tree()));
    VoxelResult again = fieldToVoxels(VoxelSource("v.vdb", back), {.voxelSize = 0.5});
    test::expectSameVoxels(voxels, again);
}

TEST(VoxelSource, AMaskHoldsWhatIsAtLeastHalf) {
    const VoxelResult parts = ball(20, {.voxelSize = 0.5, .fraction = true});
    const VoxelResult half = ball(20, {.voxelSize = 0.5, .threshold = 4});
    const auto mask = voxelsToMask(*parts.grid);
    EXPECT_EQ(static_cast<std::int64_t>(mask->activeVoxelCount()), half.voxels);
    for (auto value = half.grid->cbeginValueOn(); value; ++value) {
        ASSERT_TRUE(mask->tree().getValue(value.getCoord()));
    }
}

TEST(VoxelSource, RefusesGridsThatAreNoVoxels) {
    const auto empty = openvdb::FloatGrid::create(0.0F);
    EXPECT_EQ(kindOfFailure(empty), ErrorKind::Input);
    const auto background = openvdb::FloatGrid::create(1.0F);
    background->tree().setValue(Coord(0), 2.0F);
    EXPECT_EQ(kindOfFailure(background), ErrorKind::Input);
    const auto frustum = openvdb::FloatGrid::create(0.0F);
    frustum->tree().setValue(Coord(0), 1.0F);
    frustum->setTransform(
        openvdb::math::Transform::createFrustumTransform(BBoxd(Vec3d(0.0), Vec3d(10)), 0.5, 10));
    EXPECT_EQ(kindOfFailure(frustum), ErrorKind::Input);
}

}  // namespace
}  // namespace bandvox
