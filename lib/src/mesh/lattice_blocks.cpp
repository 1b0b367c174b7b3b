#include "mesh/lattice_blocks.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bandvox {

namespace {

using BlockLeaf = openvdb::FloatTree::LeafNodeType;
static_assert(BlockLeaf::DIM == kBlockSide);

// The cells that touch a block belong to it and to the seven blocks below.
template <typename Visit>
void forEachBlockBelow(const openvdb::Coord& origin, const Visit& visit) {
    for (int i = 0; i < 8; ++i) {
        visit(origin.offsetBy(-(i & 1) * kBlockSide, -(i >> 1 & 1) * kBlockSide,
                              -(i >> 2) * kBlockSide));
    }
}

// Where a tile inside meets another one outside there is no leaf.
void addTileFaces(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& tile, double iso,
                  std::vector<openvdb::Coord>& blocks) {
    const auto accessor = grid.getConstAccessor();
    const openvdb::Coord low = tile.min();
    const openvdb::Coord high = tile.max().offsetBy(1 - kBlockSide);
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (const bool isUpper : {false, true}) {
            openvdb::Coord block = isUpper ? high : low;
            for (block[u] = low[u]; block[u] <= high[u]; block[u] += kBlockSide) {
                for (block[v] = low[v]; block[v] <= high[v]; block[v] += kBlockSide) {
                    openvdb::Coord beyond = block;
                    beyond[axis] += isUpper ? kBlockSide : -kBlockSide;
                    if (accessor.probeConstLeaf(beyond) || accessor.getValue(beyond) > iso)
                        continue;
                    const auto add = [&](const openvdb::Coord& b) { blocks.push_back(b); };
                    forEachBlockBelow(block, add);
                    forEachBlockBelow(beyond, add);
                }
            }
        }
    }
}

}  // namespace

std::vector<openvdb::Coord> candidateBlocks(const openvdb::FloatGrid& grid, double iso, int group) {
    std::vector<openvdb::Coord> blocks;
    const auto accessor = grid.getConstAccessor();
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::Coord& origin = leaf->origin();
        forEachBlockBelow(origin, [&](const openvdb::Coord& block) {
            if (block == origin || !accessor.probeConstLeaf(block)) blocks.push_back(block);
        });
    }
    auto tile = grid.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (*tile > iso) addTileFaces(grid, tile.getBoundingBox(), iso, blocks);
    }
    const auto key = [mask = ~(group - 1)](const openvdb::Coord& c) {
        return std::tuple(c & mask, c);
    };
    std::sort(blocks.begin(), blocks.end(),
              [&](const auto& a, const auto& b) { return key(a) < key(b); });
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    return blocks;
}

void BlockValues::read(const openvdb::FloatGrid& grid, const openvdb::Coord& origin) {
    const auto accessor = grid.getConstAccessor();
    for (int i = 0; i < 8; ++i) {
        // A block, or of one above the nodes on the side that it turns to this one.
        const openvdb::Coord corner(i & 1, i >> 1 & 1, i >> 2);
        const openvdb::Coord from =
            origin +
            openvdb::Coord(corner[0] * kBlockSide, corner[1] * kBlockSide, corner[2] * kBlockSide);
        const BlockLeaf* leaf = accessor.probeConstLeaf(from);
        const float* values = leaf ? leaf->buffer().data() : nullptr;
        const float tile = values ? 0 : accessor.getValue(from);
        const auto count = [&](int axis) { return corner[axis] != 0 ? 1 : kBlockSide; };
        for (int x = 0; x < count(0); ++x) {
            for (int y = 0; y < count(1); ++y) {
                float* row = &mValues[((corner[0] * kBlockSide + x) * kBlockNodes +
                                       corner[1] * kBlockSide + y) *
                                          kBlockNodes +
                                      corner[2] * kBlockSide];
                if (values) {
                    std::copy_n(values + (x * kBlockSide + y) * kBlockSide, count(2), row);
                } else {
                    std::fill_n(row, count(2), tile);
                }
            }
        }
    }
    const bool isFinite = std::all_of(mValues.begin(), mValues.end(),
                                      [](float value) { return std::isfinite(value); });
    if (!isFinite) {
        throw Error(ErrorKind::Input, "the grid \"" + grid.getName() +
                                          "\" has values that are not finite; expected a density");
    }
}

bool BlockValues::crosses(double iso) const {
    const bool first = mValues.front() > iso;
    return std::any_of(mValues.begin(), mValues.end(),
                       [&](float value) { return (value > iso) != first; });
}

unsigned BlockValues::inside(int x, int y, int z, double iso) const {
    unsigned inside = 0;
    for (int i = 0; i < 8; ++i) {
        if (at(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)) > iso) inside |= 1U << i;
    }
    return inside;
}

}  // namespace bandvox
