#include "grid/sound_extent.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

TEST(SoundExtent, TakesWhatIsNear) {
    const auto grid = FloatGrid::create(0.0F);
    EXPECT_EQ(extentFault(*grid), "");
    grid->tree().setValueOn(Coord((1 << 30) - 8, -(1 << 30), 5), 1);
    EXPECT_EQ(extentFault(*grid), "");
    EXPECT_EQ(extentFault(*openvdb::BoolGrid::create()), "");
}

TEST(SoundExtent, RefusesWhatIsSoFarThatIndicesOverflow) {
    for (const int far : {std::numeric_limits<std::int32_t>::min(),
                          std::numeric_limits<std::int32_t>::max(), 1 << 30}) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto grid = FloatGrid::create(0.0F);
            Coord at(3, 4, 5);
            at[axis] = far;
            grid->tree().setValueOn(at, 1);
            EXPECT_NE(extentFault(*grid).find("2^30"), std::string::npos) << at;
        }
    }
    // A tile as well as a voxel.
    const auto grid = FloatGrid::create(0.0F);
    grid->tree().addTile(3, Coord(0, 0, 1 << 30), 1, true);
    EXPECT_NE(extentFault(*grid), "");
}

}  // namespace
}  // namespace bandvox
