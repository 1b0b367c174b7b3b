#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <set>

// What is marked around the large tiles of a lattice, in trees that have one voxel for each block
// of it. All boxes and places here are in blocks.
namespace bandvox {

/// One of the pieces of a shell: a face, an edge or a corner.
struct ShellPiece {
    openvdb::CoordBBox box;
    openvdb::Coord outward;  ///< -1, 0 or 1 along each axis
};

/// What encloses a box, one block thick, in 6 faces, 12 edges and 8 corners.
std::array<ShellPiece, 26> shellAround(const openvdb::CoordBBox& box);

/// Calls `visit(part)` for the part of a box in each of the cubes that fill space from the origin
/// on, of so many blocks along a side, a power of two.
template <typename Visitor>
void forEachCube(const openvdb::CoordBBox& box, int side, const Visitor& visit) {
    const auto end = [&](int from, int axis) {
        return std::min(from | (side - 1), box.max()[axis]);
    };
    openvdb::Coord low, high;
    for (low[0] = box.min()[0]; low[0] <= box.max()[0]; low[0] = high[0] + 1) {
        high[0] = end(low[0], 0);
        for (low[1] = box.min()[1]; low[1] <= box.max()[1]; low[1] = high[1] + 1) {
            high[1] = end(low[1], 1);
            for (low[2] = box.min()[2]; low[2] <= box.max()[2]; low[2] = high[2] + 1) {
                high[2] = end(low[2], 2);
                visit(openvdb::CoordBBox(low, high));
            }
        }
    }
}

/// The shells around the large tiles of a lattice, as far as no other tile has what is asked for:
/// between two tiles there is nothing to be marked. What is left is the surface of what the tiles
/// fill, and so is the memory that it takes.
template <typename BlockTree>
class TileShells {
  public:
    /// The tiles are in `blocks` already.
    TileShells(BlockTree& blocks, const Progress& progress)
        : mBlocks(blocks), mProgress(progress) {}

    /// Calls `visit(part)` for the parts of the shell around `tile`, each within a leaf of the
    /// tree; left out are those that lie in a node which is an active tile, `covers(value)` true of
    /// its value.
    template <typename Covers, typename Visitor>
    void forEachPart(const openvdb::CoordBBox& tile, const Covers& covers, const Visitor& visit) {
        for (const ShellPiece& piece : shellAround(tile)) {
            forEachCube(piece.box, Node::DIM, [&](const openvdb::CoordBBox& inNode) {
                mProgress.throwIfInterrupted();
                if (isCovered(inNode.min(), covers, kNodeTile)) return;
                forEachCube(inNode, Leaf::DIM, [&](const openvdb::CoordBBox& part) {
                    if (!isCovered(part.min(), covers, kLeafTile)) visit(part);
                });
            });
        }
    }

    /// Counts what forEachPart will make of the tree, if a leaf is made for each part.
    template <typename Covers>
    void countLeaves(const openvdb::CoordBBox& tile, const Covers& covers) {
        count(tile, covers, true);
    }
    /// The same if no leaf is made, but whole leaves become tiles.
    template <typename Covers>
    void countNodes(const openvdb::CoordBBox& tile, const Covers& covers) {
        count(tile, covers, false);
    }

    /// Bytes of what was counted. `leafBytes`: of a leaf, beyond its own size.
    double bytes(double leafBytes) const {
        constexpr double kOfAllocation = 16;
        return mLeaves * (sizeof(Leaf) + kOfAllocation + leafBytes) +
               static_cast<double>(mNodes.size()) * (sizeof(Node) + kOfAllocation);
    }

  private:
    using Leaf = typename BlockTree::LeafNodeType;
    using Node = typename BlockTree::RootNodeType::ChildNodeType::ChildNodeType;
    // Depths of values in a tree: up to these they are those of tiles as large as a node, or a
    // leaf.
    static constexpr int kNodeTile = 1, kLeafTile = 2;

    template <typename Covers>
    bool isCovered(const openvdb::Coord& place, const Covers& covers, int depth) const {
        typename BlockTree::ValueType value;
        return mBlocks.probeValue(place, value) && covers(value) &&
               mBlocks.getValueDepth(place) <= depth;
    }

    // At an edge or a corner a neighbour may have a face that takes it in.
    template <typename Covers>
    bool isOfNeighbour(const openvdb::Coord& place, const openvdb::Coord& outward,
                       const Covers& covers) const {
        for (int axis = 0; axis < 3; ++axis) {
            openvdb::Coord before = place;
            before[axis] -= outward[axis];
            if (outward[axis] != 0 && isCovered(before, covers, kLeafTile)) return true;
        }
        return false;
    }

    template <typename Covers>
    void count(const openvdb::CoordBBox& tile, const Covers& covers, bool withLeaves) {
        for (const ShellPiece& piece : shellAround(tile)) {
            const bool isFace = piece.outward.asVec3i().lengthSqr() == 1;
            forEachCube(piece.box, Node::DIM, [&](const openvdb::CoordBBox& inNode) {
                mProgress.throwIfInterrupted();
                if (isCovered(inNode.min(), covers, kNodeTile)) return;
                const bool isThere = mBlocks.getValueDepth(inNode.min()) > kNodeTile;
                if (!isThere) mNodes.insert(inNode.min() & ~(int(Node::DIM) - 1));
                if (!isThere && isFace) {
                    const openvdb::Coord first = inNode.min() >> Leaf::LOG2DIM;
                    const openvdb::Coord last = inNode.max() >> Leaf::LOG2DIM;
                    if (withLeaves) mLeaves += double(openvdb::CoordBBox(first, last).volume());
                    return;
                }
                forEachCube(inNode, Leaf::DIM, [&](const openvdb::CoordBBox& part) {
                    if (isCovered(part.min(), covers, kLeafTile) ||
                        mBlocks.getValueDepth(part.min()) > kLeafTile) {
                        return;
                    }
                    if (!isFace && isOfNeighbour(part.min(), piece.outward, covers)) return;
                    if (withLeaves) ++mLeaves;
                });
            });
        }
    }

    openvdb::tree::ValueAccessor<BlockTree> mBlocks;
    const Progress& mProgress;
    std::set<openvdb::Coord> mNodes;  // the first place of each
    double mLeaves = 0;
};

}  // namespace bandvox
