#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>

#include <gtest/gtest.h>

namespace bandvox {
namespace {

using openvdb::Vec3d;

openvdb::FloatGrid::Ptr gridIn(const std::string& unit, const std::string& space) {
    auto grid = openvdb::FloatGrid::create();
    setPlaceMetadata(*grid, {unit, space});
    grid->transform().postScale(Vec3d(1, 2, 3));
    grid->transform().postTranslate(Vec3d(10, 20, 30));
    return grid;
}

TEST(GridPlace, DiffersWhereBothAreKnown) {
    const auto lps = gridIn("mm", "left-posterior-superior");
    EXPECT_EQ(placeDifference(*lps, *gridIn("mm", "LPS")), "");
    EXPECT_EQ(placeDifference(*lps, *gridIn("", "")), "");
    EXPECT_EQ(placeDifference(*gridIn("", ""), *lps), "");
    const std::string spaces = placeDifference(*lps, *gridIn("mm", "RAS"));
    EXPECT_NE(spaces.find("right-anterior-superior"), std::string::npos) << spaces;
    EXPECT_EQ(spaces.find("mm"), std::string::npos) << spaces;
    const std::string both = placeDifference(*lps, *gridIn("m", "RAS"));
    EXPECT_NE(both.find("in mm, the other in m"), std::string::npos) << both;
}

TEST(GridPlace, TurnsToAnotherSpace) {
    const auto grid = gridIn("mm", "LPS");
    turnToSpace(*grid, "RAS");
    EXPECT_EQ(grid->indexToWorld(Vec3d(1, 1, 1)), Vec3d(-11, -22, 33));
    EXPECT_EQ(placeMetadata(*grid).space, "right-anterior-superior");
    EXPECT_EQ(placeMetadata(*grid).unit, "mm");
    turnToSpace(*grid, "LPS");
    EXPECT_EQ(grid->indexToWorld(Vec3d(1, 1, 1)), Vec3d(11, 22, 33));
}

TEST(GridPlace, TurnsOnlyWhatSaysItsOwn) {
    const auto unknown = gridIn("mm", ""), other = gridIn("mm", "scanner-xyz");
    EXPECT_THROW(turnToSpace(*unknown, "RAS"), Error);
    EXPECT_THROW(turnToSpace(*other, "RAS"), Error);
    auto vectors = openvdb::Vec3SGrid::create();
    setPlaceMetadata(*vectors, {"mm", "LPS"});
    turnToSpace(*vectors, "RAS");
    EXPECT_EQ(vectors->indexToWorld(Vec3d(1, 1, 1)), Vec3d(-1, -1, 1));
    vectors->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    EXPECT_THROW(turnToSpace(*vectors, "LPS"), Error) << "velocities would turn too";
}

}  // namespace
}  // namespace bandvox
