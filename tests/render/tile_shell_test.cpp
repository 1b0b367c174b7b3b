#include "render/tile_shell.h"

#include "stop_after.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskTree;

using Leaf = MaskTree::LeafNodeType;
using Node = MaskTree::RootNodeType::ChildNodeType::ChildNodeType;

const auto kOn = [](bool /*value*/) { return true; };

std::vector<CoordBBox> cubes(const std::vector<Coord>& firsts, int side) {
    std::vector<CoordBBox> boxes;
    for (const Coord& first : firsts) boxes.push_back(CoordBBox::createCube(first, side));
    return boxes;
}

void fill(MaskTree& tree, const std::vector<CoordBBox>& tiles) {
    for (const CoordBBox& tile : tiles) tree.sparseFill(tile, true, true);
}

TEST(ShellAround, HasEachPlaceAroundABoxOnce) {
    const CoordBBox box(Coord(-2, 5, 0), Coord(1, 9, 0));
    std::set<Coord> places;
    for (const ShellPiece& piece : shellAround(box)) {
        for (auto place = piece.box.begin(); place; ++place) {
            EXPECT_TRUE(places.insert(*place).second) << *place;
            EXPECT_FALSE(box.isInside(*place));
            for (int axis = 0; axis < 3; ++axis) {
                const int outward = (*place)[axis] > box.max()[axis]   ? 1
                                    : (*place)[axis] < box.min()[axis] ? -1
                                                                       : 0;
                EXPECT_EQ(piece.outward[axis], outward);
            }
        }
    }
    EXPECT_EQ(places.size(), 6U * 7 * 3 - 4 * 5 * 1);
}

TEST(ForEachCube, PartsABoxAtMultiplesOfTheSide) {
    const CoordBBox box(Coord(-9, 3, -1), Coord(17, 8, 16));
    std::set<Coord> cubesSeen;
    openvdb::Index64 voxels = 0;
    forEachCube(box, 8, [&](const CoordBBox& part) {
        EXPECT_TRUE(box.isInside(part));
        EXPECT_EQ(part.min() >> 3, part.max() >> 3);
        EXPECT_TRUE(cubesSeen.insert(part.min() >> 3).second);
        voxels += part.volume();
    });
    EXPECT_EQ(voxels, box.volume());
    EXPECT_EQ(cubesSeen.size(), 5U * 2 * 4);
}

// Cubes of many kinds: alone, in a row, around a corner; of a few leaves, and of whole nodes.
std::vector<std::vector<CoordBBox>> arrangements() {
    std::vector<std::vector<CoordBBox>> all;
    for (const int side : {32, 1024}) {
        all.push_back(cubes({Coord(0)}, side));
        all.push_back(
            cubes({Coord(-side, 0, side), Coord(0, 0, side), Coord(side, 0, side)}, side));
        all.push_back(cubes({Coord(0), Coord(side, 0, 0), Coord(0, side, 0)}, side));
        all.push_back(cubes({Coord(0), Coord(side)}, side));
    }
    return all;
}

TEST(TileShells, AreWhatIsBesideTilesAndInNone) {
    for (const std::vector<CoordBBox>& tiles : arrangements()) {
        if (tiles[0].dim()[0] > 32) continue;
        std::set<Coord> expected;
        for (const CoordBBox& tile : tiles) {
            CoordBBox around = tile;
            around.expand(1);
            for (auto place = around.begin(); place; ++place) expected.insert(*place);
        }
        for (const CoordBBox& tile : tiles) {
            for (auto place = tile.begin(); place; ++place) expected.erase(*place);
        }
        MaskTree tree;
        fill(tree, tiles);
        TileShells<MaskTree> shells(tree, silentProgress());
        std::set<Coord> found;
        for (const CoordBBox& tile : tiles) {
            shells.forEachPart(tile, kOn, [&](const CoordBBox& part) {
                EXPECT_EQ(part.min() >> Leaf::LOG2DIM, part.max() >> Leaf::LOG2DIM);
                for (auto place = part.begin(); place; ++place) found.insert(*place);
            });
        }
        EXPECT_EQ(found, expected);
    }
}

TEST(TileShells, ReckonTheLeavesAndNodesThatAreMade) {
    for (const std::vector<CoordBBox>& tiles : arrangements()) {
        MaskTree tree;
        fill(tree, tiles);
        const double nodesBefore = tree.nodeCount()[1];
        ASSERT_EQ(tree.leafCount(), 0U);
        TileShells<MaskTree> shells(tree, silentProgress());
        for (const CoordBBox& tile : tiles) shells.countLeaves(tile, kOn);
        const double perLeaf = shells.bytes(1) - shells.bytes(0);
        const double ofNodes = shells.bytes(-double(sizeof(Leaf)) - 16);
        for (const CoordBBox& tile : tiles) {
            shells.forEachPart(tile, kOn, [&tree](const CoordBBox& part) {
                tree.touchLeaf(part.min())->fill(part, true);
            });
        }
        // Where two tiles have but an edge in common, some count twice.
        const double leaves = tree.leafCount();
        EXPECT_GE(perLeaf, leaves);
        EXPECT_LE(perLeaf, 1.1 * leaves);
        EXPECT_EQ(ofNodes, (tree.nodeCount()[1] - nodesBefore) * (sizeof(Node) + 16));
    }
}

TEST(TileShells, AskWhetherToStop) {
    const auto tiles = cubes({Coord(0)}, 1024);
    expectStopsMidway(300, [&](Progress& progress) {
        MaskTree tree;
        fill(tree, tiles);
        TileShells<MaskTree>(tree, progress).countLeaves(tiles[0], kOn);
    });
    expectStopsMidway(300, [&](Progress& progress) {
        MaskTree tree;
        fill(tree, tiles);
        TileShells<MaskTree>(tree, progress).forEachPart(tiles[0], kOn, [](const CoordBBox&) {});
    });
}

}  // namespace
}  // namespace bandvox
