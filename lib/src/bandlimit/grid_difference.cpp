#include "bandlimit/grid_difference.h"

#include <bandvox/core/parallel.h>

#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

// The largest difference in the leaf nodes of `a`.
double differenceInLeaves(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    std::vector<const Leaf*> leaves;
    leaves.reserve(a.tree().leafCount());
    a.tree().getNodes(leaves);
    constexpr std::size_t kLeavesAtATime = 256;
    const std::size_t tasks = (leaves.size() + kLeavesAtATime - 1) / kLeavesAtATime;
    std::vector<double> largest(tasks, 0);
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        const std::size_t begin = static_cast<std::size_t>(task) * kLeavesAtATime;
        const std::size_t end = std::min(begin + kLeavesAtATime, leaves.size());
        for (std::size_t i = begin; i < end; ++i) {
            const Leaf& leaf = *leaves[i];
            const Leaf* other = b.tree().probeConstLeaf(leaf.origin());
            const float constant = other ? 0 : b.tree().getValue(leaf.origin());
            for (openvdb::Index k = 0; k < Leaf::SIZE; ++k) {
                const double value = other ? other->getValue(k) : constant;
                largest[task] = std::max(largest[task], std::abs(leaf.getValue(k) - value));
            }
        }
    });
    double result = 0;
    for (const double l : largest) result = std::max(result, l);
    return result;
}

// The largest difference where `a` has tiles, active or not, of `b` at their first voxels. Where
// `b` is finer, its own tiles and leaf nodes tell.
double differenceInTiles(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    double result = 0;
    auto tile = a.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::Coord at = tile.getBoundingBox().min();
        if (b.tree().probeConstLeaf(at) != nullptr) continue;
        result = std::max<double>(result, std::abs(*tile - b.tree().getValue(at)));
    }
    return result;
}

}  // namespace

double largestDifference(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    return std::max({differenceInLeaves(a, b), differenceInLeaves(b, a), differenceInTiles(a, b),
                     differenceInTiles(b, a)});
}

}  // namespace bandvox
