#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <vector>

namespace bandvox {

constexpr int kBlockLog2 = openvdb::FloatTree::LeafNodeType::LOG2DIM;
constexpr int kBlockSide = 1 << kBlockLog2;

/// One place along x of the 8 × 8 rows of a column: bit 8·(y mod 8) + (z mod 8) for each.
using Rows = std::uint64_t;
constexpr Rows kAllRows = ~Rows(0);
using BlockRows = std::array<Rows, kBlockSide>;  ///< of one block, x rising

/// Where a row of voxels along x enters or leaves a shell of the solid.
struct RowCrossing {
    std::int32_t voxel;   ///< the first one behind it: an index along x
    std::int16_t row;     ///< in its column: 8·(y mod 8) + (z mod 8)
    std::int16_t change;  ///< of the winding number
};

/// Blocks of a column that are inside as a whole.
struct SolidRun {
    std::int32_t begin, end;  ///< index along x / 8; the end excluded
};

/// A block of a column that is inside in part.
struct BitBlock {
    std::int32_t x;  ///< index along x / 8
    BlockRows rows;
};

/// What of a column is inside, as bits. It gets filled in the direction of x.
struct BitColumn {
    std::vector<BitBlock> blocks;  ///< x rising
    std::vector<SolidRun> solid;   ///< x rising
    bool isClosed = true;          ///< each row's winding number returns to 0
    bool isInsideOut = false;      ///< a winding number is negative somewhere

    void add(int x, const BlockRows& rows);
    /// Adds blocks [begin, end) in which each row is inside all along, or not at all.
    void addUncrossed(int begin, int end, Rows inside);
};

/// Fills a column from its crossings, in any order, which get sorted. A voxel is inside if the
/// changes up to it add up to more than 0.
BitColumn fillColumn(std::vector<RowCrossing>& crossings);

}  // namespace bandvox
