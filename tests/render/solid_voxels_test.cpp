#include "render/solid_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

using bandvox::Ray;
using bandvox::SolidVoxels;
using bandvox::VoxelHit;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

// Where a ray enters the cube of a voxel, and leaves it.
struct Passage {
    double enters = 0, leaves = HUGE_VAL;
};

Passage passageThrough(const Ray& ray, const Coord& voxel) {
    Passage passage;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = (voxel[axis] - 0.5 - ray.origin[axis]) / ray.direction[axis];
        const double high = (voxel[axis] + 0.5 - ray.origin[axis]) / ray.direction[axis];
        passage.enters = std::max(passage.enters, std::min(low, high));
        passage.leaves = std::min(passage.leaves, std::max(low, high));
    }
    return passage;
}

TEST(SolidVoxels, FindsTheFirstOfManyAsASearchOfAllDoes) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> place(-40, 300);
    std::uniform_real_distribution<double> anywhere(-100, 400), any(-1, 1);
    auto grid = openvdb::FloatGrid::create(0);
    std::vector<Coord> solid;
    for (int i = 0; i < 600; ++i) {
        // Some far away, so that there are empty nodes of every size.
        const int far = i % 50 == 0 ? 5000 : 0;
        solid.emplace_back(place(random) + far, place(random), place(random) - far);
        grid->tree().setValue(solid.back(), 0.5F);
        grid->tree().setValue(solid.back().offsetBy(1, 1, 0), 0.49F);
    }
    for (const Coord& voxel : solid) grid->tree().setValue(voxel, 0.5F);
    const SolidVoxels voxels(*grid, 0.5);
    const SolidVoxels::Probe probe = voxels.probe();
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
        Ray ray{Vec3d(anywhere(random), anywhere(random), anywhere(random)),
                Vec3d(any(random), any(random), any(random))};
        // Most towards one of them.
        if (i % 4 > 0) {
            ray.direction = solid[i % solid.size()].asVec3d() - ray.origin +
                            0.45 * Vec3d(any(random), any(random), any(random));
        }
        double nearest = HUGE_VAL;
        for (const Coord& voxel : solid) {
            const Passage passage = passageThrough(ray, voxel);
            if (passage.enters < passage.leaves) nearest = std::min(nearest, passage.enters);
        }
        const auto hit = voxels.firstHit(ray, probe);
        ASSERT_EQ(hit.has_value(), nearest < HUGE_VAL) << i;
        if (!hit) continue;
        ++hits;
        const Passage passage = passageThrough(ray, hit->voxel);
        EXPECT_NEAR(hit->t, nearest, 1e-9);
        EXPECT_NEAR(hit->t, passage.enters, 1e-9);
        if (hit->axis < 0) continue;
        const double face = hit->voxel[hit->axis] + 0.5 * hit->side;
        EXPECT_NEAR(ray.origin[hit->axis] + hit->t * ray.direction[hit->axis], face, 1e-6);
        EXPECT_LT(hit->side * ray.direction[hit->axis], 0);
    }
    EXPECT_GT(hits, 3000);
}

TEST(SolidVoxels, TakesTilesWhetherActiveOrNot) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().addTile(1, Coord(8, 0, 0), 1, true);
    grid->tree().addTile(1, Coord(32, 0, 0), 1, false);
    grid->tree().addTile(2, Coord(256, 0, 0), 0.7F, true);
    grid->tree().addTile(1, Coord(64, 64, 0), 0.4F, true);
    const SolidVoxels voxels(*grid, 0.5);
    EXPECT_EQ(voxels.maximum(), 1);
    const SolidVoxels::Probe probe = voxels.probe();
    for (const double begin : {-10.0, 20.0, 60.0}) {
        const auto hit = voxels.firstHit({Vec3d(begin, 3, 3), Vec3d(2, 0, 0)}, probe);
        ASSERT_TRUE(hit);
        const int first = begin < 0 ? 8 : begin < 30 ? 32 : 256;
        EXPECT_EQ(hit->voxel, Coord(first, 3, 3));
        EXPECT_DOUBLE_EQ(hit->t, (first - 0.5 - begin) / 2);
        EXPECT_EQ(hit->axis, 0);
        EXPECT_EQ(hit->side, -1);
    }
    EXPECT_FALSE(voxels.firstHit({Vec3d(60, 64, 3), Vec3d(1, 1, 0)}, probe));
    EXPECT_FALSE(voxels.firstHit({Vec3d(0, 3, 3), Vec3d(-1, 0, 0)}, probe));
}

TEST(SolidVoxels, ARayMayStartInside) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->fill(CoordBBox(Coord(-4), Coord(4)), 1);
    const SolidVoxels voxels(*grid, 0.5);
    const auto hit = voxels.firstHit({Vec3d(4.49, 0, 0), Vec3d(0, 1, 0)}, voxels.probe());
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0);
    EXPECT_EQ(hit->axis, -1);
    EXPECT_FALSE(voxels.firstHit({Vec3d(4.51, 0, 0), Vec3d(0, 1, 0)}, voxels.probe()));
}

TEST(SolidVoxels, AnIsoThatFloatsRoundIsReached) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->tree().setValue(Coord(0), 0.7F);
    EXPECT_FALSE(SolidVoxels(*grid, 0.7).empty());
    const SolidVoxels none(*grid, 0.71);
    EXPECT_TRUE(none.empty());
    EXPECT_FALSE(none.firstHit({Vec3d(-5, 0, 0), Vec3d(1, 0, 0)}, none.probe()));
}

}  // namespace
