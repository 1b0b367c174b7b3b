#include "reconstruct/nodes_in_band.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"

#include <array>
#include <bit>
#include <cstdint>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kSide = Leaf::DIM;

// For each x of a leaf and each y a byte, whose bits are the voxels along z that lie in a band.
using LeafRows = std::array<std::uint8_t, kSide * kSide>;

// False if there is none.
BANDVOX_FOR_EACH_INSTRUCTION_SET
bool rowsInBand(const float* values, const DensityBand& band, LeafRows& rows) {
    constexpr int kLanes = 16;
    Lanes<kLanes> some, highest, lowest;
    loadLanes<kLanes>(values, highest);
    lowest = highest;
    for (openvdb::Index i = kLanes; i < Leaf::SIZE; i += kLanes) {
        loadLanes<kLanes>(values + i, some);
        highest = some > highest ? some : highest;
        lowest = some < lowest ? some : lowest;
    }
    int mayHold = 0;
    for (int l = 0; l < kLanes; ++l) mayHold |= highest[l] >= band.low ? 1 : 0;
    int mayMiss = 0;
    for (int l = 0; l < kLanes; ++l) mayMiss |= lowest[l] <= band.high ? 1 : 0;
    if ((mayHold & mayMiss) == 0) return false;
    for (int row = 0; row < kSide * kSide; ++row) {
        const float* along = values + row * kSide;
        unsigned bits = 0;
        for (int z = 0; z < kSide; ++z) {
            bits |= along[z] >= band.low && along[z] <= band.high ? 1U << z : 0U;
        }
        rows[row] = static_cast<std::uint8_t>(bits);
    }
    return true;
}

}  // namespace

openvdb::CoordBBox nodesInBand(
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& values,
    const openvdb::CoordBBox& box, const DensityBand& band) {
    openvdb::CoordBBox found;
    const openvdb::Coord begin = box.min() & ~(kSide - 1);
    LeafRows rows;
    openvdb::Coord block;
    for (block[0] = begin[0]; block[0] <= box.max()[0]; block[0] += kSide) {
        for (block[1] = begin[1]; block[1] <= box.max()[1]; block[1] += kSide) {
            for (block[2] = begin[2]; block[2] <= box.max()[2]; block[2] += kSide) {
                openvdb::CoordBBox part = openvdb::CoordBBox::createCube(block, kSide);
                part.intersect(box);
                const Leaf* leaf = values.probeConstLeaf(block);
                if (!leaf) {
                    const float tile = values.getValue(block);
                    if (tile >= band.low && tile <= band.high) found.expand(part);
                    continue;
                }
                if (found.isInside(part) || !rowsInBand(leaf->buffer().data(), band, rows)) {
                    continue;
                }
                const openvdb::Coord first = part.min() - block, last = part.max() - block;
                const auto alongZ =
                    static_cast<std::uint8_t>((0xFFU << first[2]) & (0xFFU >> (7 - last[2])));
                for (int x = first[0]; x <= last[0]; ++x) {
                    for (int y = first[1]; y <= last[1]; ++y) {
                        const auto row = static_cast<std::uint8_t>(rows[x * kSide + y] & alongZ);
                        if (row == 0) continue;
                        found.expand(block.offsetBy(x, y, std::countr_zero(row)));
                        found.expand(block.offsetBy(x, y, 7 - std::countl_zero(row)));
                    }
                }
            }
        }
    }
    return found;
}

}  // namespace bandvox
