#include "resample/source_grid.h"

#include "grid/copy_box.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bandvox {

namespace {

using SourceTree = openvdb::FloatTree;
using SourceLeaf = SourceTree::LeafNodeType;
constexpr int kLeafSide = SourceLeaf::DIM;

// Sides of the tiles at the depths of a tree, from its root.
constexpr int kTileSides[] = {4096, 128, 8};

ValueRange joined(const ValueRange& a, const ValueRange& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

ValueRange rangeOf(const SourceLeaf& leaf, bool& finite) {
    const float* values = leaf.buffer().data();
    ValueRange range{values[0], values[0]};
    for (openvdb::Index i = 0; i < SourceLeaf::SIZE; ++i) {
        finite = finite && std::isfinite(values[i]);
        range = joined(range, {values[i], values[i]});
    }
    return range;
}

}  // namespace

ValueRange finiteRange(const openvdb::FloatGrid& grid) {
    std::vector<const SourceLeaf*> leaves;
    grid.tree().getNodes(leaves);
    constexpr std::size_t kLeavesPerTask = 1024;
    struct Part {
        ValueRange range;
        bool finite;
    };
    const float background = grid.background();
    std::vector<Part> parts((leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask,
                            {{background, background}, true});
    parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t task) {
        Part& part = parts[static_cast<std::size_t>(task)];
        const std::size_t begin = static_cast<std::size_t>(task) * kLeavesPerTask;
        const std::size_t end = std::min(begin + kLeavesPerTask, leaves.size());
        for (std::size_t i = begin; i < end; ++i) {
            part.range = joined(part.range, rangeOf(*leaves[i], part.finite));
        }
    });
    ValueRange range{background, background};
    bool finite = std::isfinite(background);
    for (const Part& part : parts) {
        range = joined(range, part.range);
        finite = finite && part.finite;
    }
    auto tile = grid.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        finite = finite && std::isfinite(*tile);
        range = joined(range, {*tile, *tile});
    }
    if (!finite) {
        throw Error(ErrorKind::Input, "the grid \"" + grid.getName() +
                                          "\" holds values that are not finite; expected numbers");
    }
    return range;
}

std::optional<ConstantRegion> SourceReader::constantIn(const openvdb::CoordBBox& box) const {
    const openvdb::Coord& first = box.min();
    if (mAccessor.probeConstLeaf(first)) return std::nullopt;
    const ConstantRegion region{mAccessor.getValue(first), mAccessor.isValueOn(first)};

    // All of it may lie in one tile.
    const int depth = mAccessor.getValueDepth(first);
    if (depth >= 0) {
        const int side = kTileSides[depth];
        if ((first & ~(side - 1)) == (box.max() & ~(side - 1))) return region;
    }
    openvdb::Coord at;
    const openvdb::Coord begin = first & ~(kLeafSide - 1);
    for (at[0] = begin[0]; at[0] <= box.max()[0]; at[0] += kLeafSide) {
        for (at[1] = begin[1]; at[1] <= box.max()[1]; at[1] += kLeafSide) {
            for (at[2] = begin[2]; at[2] <= box.max()[2]; at[2] += kLeafSide) {
                if (mAccessor.probeConstLeaf(at) || mAccessor.getValue(at) != region.value ||
                    mAccessor.isValueOn(at) != region.active) {
                    return std::nullopt;
                }
            }
        }
    }
    return region;
}

void SourceReader::copy(const SourceCube& cube, float* to) const {
    const std::size_t row = cube.zStride;
    copyBox(mAccessor, cube.box, to, row * cube.yCount, row);
}

std::vector<openvdb::Coord> blocksNear(const openvdb::FloatGrid& grid, const LatticeMap& map,
                                       const BlockFilter& filter) {
    constexpr std::size_t kMostBlocks = std::size_t(1) << 28;
    std::vector<openvdb::Coord> blocks;
    std::size_t sorted = 0;  // blocks up to here are in order, each once
    const auto sort = [&] {
        std::sort(blocks.begin(), blocks.end());
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        sorted = blocks.size();
    };
    const auto add = [&](openvdb::CoordBBox voxels) {
        voxels.expand(filter.reach() + 1);
        const openvdb::BBoxd places =
            map.toTarget(openvdb::BBoxd(voxels.min().asVec3d(), voxels.max().asVec3d()));
        const double side = filter.blockSide();
        const openvdb::Coord low = openvdb::Coord::floor(places.min() / side);
        const openvdb::Coord high = openvdb::Coord::floor(places.max() / side);
        const openvdb::Vec3d counts = (high - low).offsetBy(1).asVec3d();
        if (counts[0] * counts[1] * counts[2] > double(kMostBlocks)) {
            throw Error(ErrorKind::Memory,
                        "the grid has tiles so large that the new lattice would "
                        "have more than 2^28 blocks of them");
        }
        for (int x = low[0]; x <= high[0]; ++x) {
            for (int y = low[1]; y <= high[1]; ++y) {
                for (int z = low[2]; z <= high[2]; ++z) blocks.emplace_back(x, y, z);
            }
        }
        if (blocks.size() > 2 * sorted + 100000) sort();
    };
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) add(leaf->getNodeBoundingBox());
    auto tile = grid.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (*tile != grid.background()) add(tile.getBoundingBox());
    }
    sort();
    return blocks;
}

}  // namespace bandvox
