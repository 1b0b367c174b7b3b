#include "render/surface_blocks.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"
#include "render/tile_shell.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace bandvox {

namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using LeafParent = Tree::RootNodeType::ChildNodeType::ChildNodeType;
using BlockLeaf = openvdb::MaskTree::LeafNodeType;

// The surface may lie this many voxels beyond the outermost high value of the lattice: where it
// is, one of the nodes around is high.
constexpr int kSurfaceMargin = 1;

// Blocks in and around a leaf, four along each axis of which its own are the inner two: block
// (i, j, k) is bit 16·i + 4·j + k.
using NearBlocks = std::uint64_t;
constexpr NearBlocks kAllNear = ~NearBlocks(0);

struct LeafSummary {
    NearBlocks blocks = 0;  // within the margin of a high value
    float maximum = std::numeric_limits<float>::lowest();
    bool finite = true;
};

constexpr float kLargest = 1e30F;

bool isFinite(float value) {
    return std::abs(value) <= kLargest;
}

// The blocks, as bits 0 to 3, within the margin of the voxels of a row, of which each is a bit.
constexpr std::array<std::uint8_t, 256> nearRows() {
    std::array<std::uint8_t, 256> near{};
    for (unsigned row = 0; row < 256; ++row) {
        for (int voxel = 0; voxel < 8; ++voxel) {
            if ((row >> voxel & 1) == 0) continue;
            const int first = (voxel + 4 - kSurfaceMargin) / 4;
            const int last = (voxel + 4 + kSurfaceMargin) / 4;
            for (int block = first; block <= last; ++block) {
                near[row] = static_cast<std::uint8_t>(near[row] | 1U << block);
            }
        }
    }
    return near;
}
constexpr std::array<std::uint8_t, 256> kNearRows = nearRows();

BANDVOX_FOR_EACH_INSTRUCTION_SET
LeafSummary summarize(const float* values, float threshold) {
    // What is the same for all of a leaf is common.
    constexpr int kLanes = 16;
    LeafSummary found;
    Lanes<kLanes> some, highest, lowest;
    loadLanes<kLanes>(values, highest);
    lowest = highest;
    int large = 0;
    for (openvdb::Index i = 0; i < Leaf::SIZE; i += kLanes) {
        loadLanes<kLanes>(values + i, some);
        highest = some > highest ? some : highest;
        lowest = some < lowest ? some : lowest;
        for (int l = 0; l < kLanes; ++l) large |= std::abs(values[i + l]) <= kLargest ? 0 : 1;
    }
    float minimum = lowest[0];
    found.maximum = highest[0];
    for (int l = 1; l < kLanes; ++l) {
        found.maximum = std::max(found.maximum, highest[l]);
        minimum = std::min(minimum, lowest[l]);
    }
    found.finite = large == 0;
    if (!(found.maximum >= threshold)) return found;
    if (minimum >= threshold) {
        found.blocks = kAllNear;
        return found;
    }
    for (int x = 0; x < 8; ++x) {
        std::uint64_t plane = 0;  // 16 bits: blocks along y and z
        for (int y = 0; y < 8; ++y) {
            const float* row = values + 64 * x + 8 * y;
            unsigned high = 0;
            for (int z = 0; z < 8; ++z) high |= row[z] >= threshold ? 1U << z : 0U;
            const std::uint64_t alongZ = kNearRows[high];
            const unsigned alongY = kNearRows[1U << y];
            for (int j = 0; j < 4; ++j) plane |= (alongY >> j & 1) != 0 ? alongZ << 4 * j : 0;
        }
        const unsigned alongX = kNearRows[1U << x];
        for (int i = 0; i < 4; ++i) found.blocks |= (alongX >> i & 1) != 0 ? plane << 16 * i : 0;
    }
    return found;
}

// Marks blocks near leaves in a tree of blocks.
class BlockMarker {
  public:
    explicit BlockMarker(openvdb::MaskTree& blocks) : mBlocks(blocks) {}

    void mark(const openvdb::Coord& leaf, NearBlocks blocks) {
        if (blocks == 0) return;
        const openvdb::Coord first = (leaf >> 2).offsetBy(-1);
        for (int row = 0; row < 16; ++row) {
            const auto alongZ = static_cast<unsigned>(blocks >> 4 * row & 15);
            if (alongZ == 0) continue;
            // The row may lie across two of the tree's leaves.
            openvdb::Coord at = first.offsetBy(row / 4, row % 4, 0);
            const int place = at[2] & 7;
            markRow(at, alongZ << place & 255);
            at[2] += 8 - place;
            if (alongZ << place >> 8 != 0) markRow(at, alongZ << place >> 8);
        }
    }

  private:
    // Eight blocks along z, in one leaf of the tree.
    void markRow(const openvdb::Coord& at, unsigned row) {
        if (row == 0) return;
        auto* leaf = mBlocks.touchLeaf(at);
        leaf->buffer().data()[at[0] & 7] |= static_cast<std::uint64_t>(row) << 8 * (at[1] & 7);
    }

    openvdb::tree::ValueAccessor<openvdb::MaskTree, false> mBlocks;
};

// The blocks of some of a tree's nodes.
struct SomeBlocks {
    openvdb::MaskTree blocks;
    float maximum = std::numeric_limits<float>::lowest();
    bool finite = true;

    void note(float value) {
        maximum = std::max(maximum, value);
        finite = finite && isFinite(value);
    }
};

// What a function of type void(const Node&, BlockMarker&, SomeBlocks&) finds in each of the nodes,
// by all threads, put together.
template <typename Node, typename Examine>
SomeBlocks examineNodes(const std::vector<const Node*>& nodes, std::size_t nodesPerTask,
                        const Progress& progress, const Examine& examine) {
    std::vector<SomeBlocks> parts((nodes.size() + nodesPerTask - 1) / nodesPerTask);
    parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        SomeBlocks& part = parts[static_cast<std::size_t>(task)];
        BlockMarker marker(part.blocks);
        const std::size_t begin = static_cast<std::size_t>(task) * nodesPerTask;
        const std::size_t end = std::min(begin + nodesPerTask, nodes.size());
        for (std::size_t i = begin; i < end; ++i) examine(*nodes[i], marker, part);
    });
    SomeBlocks all;
    for (const SomeBlocks& part : parts) {
        progress.throwIfInterrupted();
        all.blocks.topologyUnion(part.blocks);
        all.maximum = std::max(all.maximum, part.maximum);
        all.finite = all.finite && part.finite;
    }
    return all;
}

}  // namespace

SurfaceBlocks::SurfaceBlocks(const openvdb::FloatGrid& grid, double threshold,
                             const Progress& progress)
    : mMaximum(grid.background()) {
    const auto limit = static_cast<float>(threshold);
    const auto add = [this](const SomeBlocks& some) {
        mBlocks.topologyUnion(some.blocks);
        mMaximum = std::max<double>(mMaximum, some.maximum);
        mFinite = mFinite && some.finite;
    };

    // Leaves.
    constexpr std::size_t kLeavesPerTask = 4096;
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    add(examineNodes(leaves, kLeavesPerTask, progress,
                     [limit](const Leaf& leaf, BlockMarker& marker, SomeBlocks& found) {
                         const LeafSummary summary = summarize(leaf.buffer().data(), limit);
                         found.maximum = std::max(found.maximum, summary.maximum);
                         found.finite = found.finite && summary.finite;
                         marker.mark(leaf.origin(), summary.blocks);
                     }));

    // Tiles as large as leaves.
    constexpr std::size_t kNodesPerTask = 16;
    std::vector<const LeafParent*> parents;
    grid.tree().getNodes(parents);
    add(examineNodes(parents, kNodesPerTask, progress,
                     [limit](const LeafParent& parent, BlockMarker& marker, SomeBlocks& found) {
                         for (auto tile = parent.cbeginValueAll(); tile; ++tile) {
                             found.note(*tile);
                             if (*tile >= limit) marker.mark(tile.getCoord(), kAllNear);
                         }
                     }));

    // Larger tiles.
    SomeBlocks large;
    std::vector<openvdb::CoordBBox> tiles;
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 2);
    for (; tile; ++tile) {
        progress.throwIfInterrupted();
        large.note(*tile);
        if (*tile >= limit) tiles.push_back(tile.getBoundingBox());
    }
    add(large);
    markLargeTiles(tiles, progress);

    mBox = boxOfBlocks(mBlocks);
}

void SurfaceBlocks::markLargeTiles(const std::vector<openvdb::CoordBBox>& tiles,
                                   const Progress& progress) {
    if (tiles.empty()) return;
    // Their own blocks fill whole nodes of the tree.
    static_assert(LeafParent::DIM % (kSide * BlockLeaf::DIM) == 0 && kSurfaceMargin <= kSide);
    const auto blocksOf = [](const openvdb::CoordBBox& voxels) {
        return openvdb::CoordBBox(voxels.min() >> kLog2, voxels.max() >> kLog2);
    };
    for (const openvdb::CoordBBox& tile : tiles) {
        progress.throwIfInterrupted();
        mBlocks.sparseFill(blocksOf(tile), true, true);
    }

    // A layer of blocks around them, where no tile is, takes leaves. A tree that runs out of memory
    // ends the process while it is destroyed, so do not let it come to that.
    const auto isOn = [](bool /*value*/) { return true; };
    TileShells<openvdb::MaskTree> shells(mBlocks, progress);
    for (const openvdb::CoordBBox& tile : tiles) shells.countLeaves(blocksOf(tile), isOn);
    constexpr double kListed = sizeof(Group) + sizeof(void*);  // of a leaf, in lists of them
    requireMemory(shells.bytes(kListed), "the surface of the grid's tiles");
    openvdb::tree::ValueAccessor<openvdb::MaskTree> blocks(mBlocks);
    for (const openvdb::CoordBBox& tile : tiles) {
        shells.forEachPart(blocksOf(tile), isOn, [&blocks](const openvdb::CoordBBox& part) {
            blocks.touchLeaf(part.min())->fill(part, true);
        });
    }
}

std::vector<SurfaceBlocks::Group> SurfaceBlocks::groups(const Progress& progress) const {
    std::vector<Group> groups;
    groups.reserve(mBlocks.leafCount() + mBlocks.activeTileCount());
    for (auto leaf = mBlocks.cbeginLeaf(); leaf; ++leaf) {
        progress.throwIfInterrupted();
        groups.push_back({leaf->origin() << kLog2, 1 << BlockLeaf::LOG2DIM, leaf->buffer().data()});
    }
    auto tile = mBlocks.cbeginValueOn();
    tile.setMaxDepth(openvdb::MaskTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        groups.push_back({box.min() << kLog2, box.dim()[0], nullptr});
    }
    return groups;
}

std::optional<double> SurfaceBlocks::entry(const Ray& ray) const {
    BlockRay blockRay = inBlocks(ray, kSide);
    if (empty() || !blockRay.clip(mBox)) return std::nullopt;
    return blockRay.t0();
}

bool SurfaceBlocks::touches(const openvdb::BBoxd& box) const {
    constexpr double kMost = 64;  // blocks that are looked at
    const openvdb::Vec3d low = box.min() / kSide, high = box.max() / kSide;
    if (empty() || !mBox.hasOverlap({low, high})) return false;
    if ((high - low).length() > kMost) return true;
    const openvdb::Coord first = openvdb::Coord::floor(low), last = openvdb::Coord::floor(high);
    if (openvdb::CoordBBox(first, last).volume() > static_cast<openvdb::Index64>(kMost)) {
        return true;
    }
    for (int x = first[0]; x <= last[0]; ++x) {
        for (int y = first[1]; y <= last[1]; ++y) {
            for (int z = first[2]; z <= last[2]; ++z) {
                if (mBlocks.isValueOn({x, y, z})) return true;
            }
        }
    }
    return false;
}

}  // namespace bandvox
