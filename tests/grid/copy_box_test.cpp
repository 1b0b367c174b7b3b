#include "grid/copy_box.h"

#include <gtest/gtest.h>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

TEST(ValueOfLargeTiles, IsKnownWhereAllOfABoxLiesInThem) {
    auto grid = openvdb::FloatGrid::create(0.25F);
    auto& tree = grid->tree();
    tree.addTile(3, Coord(0), 2.0F, true);  // 4096³ voxels
    tree.addTile(3, Coord(4096, 0, 0), 2.0F, true);
    tree.addTile(3, Coord(0, 4096, 0), 3.0F, true);
    tree.addTile(2, Coord(-128), 5.0F, false);  // 128³ voxels
    tree.addTile(1, Coord(-512), 7.0F, true);   // 8³ voxels
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> values(tree);
    const auto at = [&](const Coord& first, int side) {
        return valueOfLargeTiles(values, CoordBBox::createCube(first, side));
    };
    EXPECT_EQ(at(Coord(1000), 60), 2.0F);
    EXPECT_EQ(at(Coord(4070, 100, 100), 60), 2.0F) << "across two of one value";
    EXPECT_EQ(at(Coord(100, 4070, 100), 60), std::nullopt) << "across two of different values";
    EXPECT_EQ(at(Coord(100, 100, 4070), 60), std::nullopt) << "out of it";
    EXPECT_EQ(at(Coord(-100), 100), 5.0F);
    EXPECT_EQ(at(Coord(-128), 128), 5.0F);
    EXPECT_EQ(at(Coord(-101), 130), std::nullopt) << "of more than 128 voxels along a side";
    EXPECT_EQ(at(Coord(1000), 129), std::nullopt);
    EXPECT_EQ(at(Coord(-512), 8), std::nullopt) << "a small tile";
    EXPECT_EQ(at(Coord(-4096 * 5), 60), 0.25F) << "the background";
    tree.setValue(Coord(1020), 2.5F);
    EXPECT_EQ(at(Coord(1000), 60), std::nullopt) << "a leaf";
}

}  // namespace
}  // namespace bandvox
