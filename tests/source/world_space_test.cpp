#include <bandvox/source/world_space.h>

#include <gtest/gtest.h>

namespace bandvox {
namespace {

using openvdb::Mat4d;
using openvdb::Vec3d;

TEST(WorldSpace, HasOneNameOnly) {
    for (const char* words : {"LPS", "lps", "Left-Posterior-Superior", "left-posterior-superior"}) {
        EXPECT_EQ(worldSpaceName(words), "left-posterior-superior") << words;
    }
    EXPECT_EQ(worldSpaceName("RAS"), "right-anterior-superior");
    EXPECT_EQ(worldSpaceName("LAS"), "left-anterior-superior");
    EXPECT_EQ(worldSpaceName("scanner-xyz"), "scanner-xyz");
    EXPECT_EQ(worldSpaceName(""), "");
}

TEST(WorldSpace, TurnsIntoAnother) {
    const Vec3d place(1, 2, 3);
    EXPECT_EQ(spaceToSpace("LPS", "RAS")->transform(place), Vec3d(-1, -2, 3));
    EXPECT_EQ(spaceToSpace("right-anterior-superior", "LPS")->transform(place), Vec3d(-1, -2, 3));
    EXPECT_EQ(spaceToSpace("LAS", "lps")->transform(place), Vec3d(1, -2, 3));
    EXPECT_EQ(spaceToSpace("LPS", "LPS")->transform(place), place);
    EXPECT_FALSE(spaceToSpace("", "LPS"));
    EXPECT_FALSE(spaceToSpace("LPS", "scanner-xyz"));
}

TEST(WorldSpace, TellsWhereAxesComeFrom) {
    Mat4d axes = Mat4d::identity();
    EXPECT_EQ(axesFrom(axes), "RAI");
    axes(0, 0) = -2;
    axes(2, 2) = -0.1;
    EXPECT_EQ(axesFrom(axes), "LAS");
    // A sagittal series: x runs to posterior, y down, z to the left.
    const Mat4d sagittal(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 5.0, 6.0, 7.0,
                         1.0);
    EXPECT_EQ(axesFrom(sagittal), "ASR");
    // Two axes that are both nearest to one direction: the nearer one has it.
    const Mat4d oblique(3.0, 2.9, 0.0, 0.0, 3.0, -2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0,
                        1.0);
    EXPECT_EQ(axesFrom(oblique), "ARI");
}

}  // namespace
}  // namespace bandvox
