#include "render/surface_blocks.h"

#include "render/examine_leaves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace bandvox {

namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

// The surface may lie this many voxels beyond the outermost high value of the lattice: where it
// is, one of the nodes around is high.
constexpr int kSurfaceMargin = 1;

struct HighLeaf {
    // Of each eighth of the leaf the voxels at or above the threshold; empty if there are none.
    std::array<openvdb::CoordBBox, 8> high;
    float maximum;
    bool finite = true;
};

bool isFinite(float value) {
    constexpr float kLargest = 1e30F;
    return std::abs(value) <= kLargest;
}

HighLeaf findHigh(const Leaf& leaf, float threshold) {
    HighLeaf found{{}, std::numeric_limits<float>::lowest()};
    const float* values = leaf.buffer().data();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        found.maximum = std::max(found.maximum, values[i]);
        found.finite = found.finite && isFinite(values[i]);
        if (!(values[i] >= threshold)) continue;
        // Offsets are x, y, z, three bits each.
        const openvdb::Index eighth = (i >> 6 & 4) | (i >> 4 & 2) | (i >> 2 & 1);
        found.high[eighth].expand(leaf.offsetToGlobalCoord(i));
    }
    return found;
}

}  // namespace

SurfaceBlocks::SurfaceBlocks(const openvdb::FloatGrid& grid, double threshold)
    : mMaximum(grid.background()) {
    // Examine the leaves, then mark in their order.
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    const auto limit = static_cast<float>(threshold);
    const std::vector<HighLeaf> found =
        examineLeaves(leaves, [limit](const Leaf& leaf) { return findHigh(leaf, limit); });
    for (const HighLeaf& leaf : found) {
        mMaximum = std::max<double>(mMaximum, leaf.maximum);
        mFinite = mFinite && leaf.finite;
        for (const openvdb::CoordBBox& high : leaf.high) {
            if (!high.empty()) mark(high);
        }
    }

    // Mark the tiles.
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        mFinite = mFinite && isFinite(tile.getValue());
        if (!(tile.getValue() >= limit)) continue;
        mMaximum = std::max<double>(mMaximum, tile.getValue());
        mark(tile.getBoundingBox());
    }

    mBox = boxOfBlocks(mBlocks);
}

void SurfaceBlocks::mark(const openvdb::CoordBBox& voxels) {
    openvdb::CoordBBox blocks(voxels.min().offsetBy(-kSurfaceMargin),
                              voxels.max().offsetBy(kSurfaceMargin));
    blocks.min() >>= kLog2;
    blocks.max() >>= kLog2;
    mBlocks.sparseFill(blocks, true, true);
}

std::optional<double> SurfaceBlocks::entry(const Ray& ray) const {
    BlockRay blockRay = inBlocks(ray, kSide);
    if (mBlocks.empty() || !blockRay.clip(mBox)) return std::nullopt;
    return blockRay.t0();
}

}  // namespace bandvox
