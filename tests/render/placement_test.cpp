#include <bandvox/core/error.h>
#include <bandvox/render/placement.h>

#include <gtest/gtest.h>

#include <limits>

namespace {

using openvdb::Vec3d;

bandvox::SceneObject objectWithGrids() {
    bandvox::SceneObject object;
    auto grid = openvdb::FloatGrid::create();
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    object.grid = grid;
    auto colors = openvdb::Vec3SGrid::create();
    colors->setTransform(grid->transformPtr());
    object.colors = colors;
    return object;
}

TEST(Placement, ScalesThenTurnsThenMoves) {
    bandvox::SceneObject object = objectWithGrids();
    const auto before = object.grid;
    bandvox::place(object, {2, {0, 0, 90}, {10, 0, 0}});
    // (1, 2, 3) is twice as far, a quarter turn about z farther on, and 10 to the right.
    const Vec3d index = before->worldToIndex(Vec3d(1, 2, 3));
    EXPECT_TRUE(object.grid->indexToWorld(index).eq(Vec3d(10 - 4, 2, 6), 1e-12));
    EXPECT_TRUE(object.colors->indexToWorld(index).eq(Vec3d(6, 2, 6), 1e-12));
    EXPECT_EQ(object.temperatures, nullptr);
    EXPECT_EQ(&object.grid->constTree(), &before->constTree());
}

TEST(Placement, NothingIsDoneWhereNothingIsAsked) {
    bandvox::SceneObject object = objectWithGrids();
    const auto before = object.grid;
    bandvox::place(object, {});
    EXPECT_EQ(object.grid, before);
}

TEST(Placement, ScalesThatAreNoneAreRefused) {
    bandvox::SceneObject object = objectWithGrids();
    for (const double scale : {0.0, -1.0, 1e-30, std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(bandvox::place(object, {scale}), bandvox::Error) << scale;
    }
}

}  // namespace
