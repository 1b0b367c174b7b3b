#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace bandvox {

using VoxelLeaf = openvdb::FloatTree::LeafNodeType;

constexpr int kBlockLog2 = VoxelLeaf::LOG2DIM;
constexpr int kBlockSide = VoxelLeaf::DIM;

/// Where a row of voxels along x enters or leaves a shell of the solid.
struct RowCrossing {
    std::int32_t voxel;   ///< the first one behind it: an index along x
    std::int16_t row;     ///< in its column: 8·(y mod 8) + (z mod 8)
    std::int16_t change;  ///< of the winding number
};

/// Leaf nodes of a column that are inside as a whole.
struct SolidRun {
    std::int32_t begin, end;  ///< index along x / 8; the end excluded
};

/// The voxels inside of one column.
struct ColumnVoxels {
    std::vector<std::unique_ptr<VoxelLeaf>> leaves;  ///< those in part inside, x rising
    std::vector<SolidRun> solid;                     ///< x rising
    std::int64_t voxels = 0;                         ///< inside
    bool isClosed = true;                            ///< each row's winding number returns to 0
    bool isInsideOut = false;                        ///< a winding number is negative somewhere
};

/// Fills a column from its crossings, in any order, which get sorted. A voxel is inside if the
/// changes up to it add up to more than 0. `block`: a leaf node of the column, voxel / 8; its x
/// does not matter.
ColumnVoxels fillColumn(const openvdb::Coord& block, std::vector<RowCrossing>& crossings);

}  // namespace bandvox
