#pragma once

#include "bandlimit/block_store.h"

#include <vector>

namespace bandvox {

struct AssemblyOptions {
    double voxelSize;  ///< world units
    double threshold;  ///< values nearer to a whole number than this are stored as it
    bool clamp;        ///< limit values to [0, 1]
};

/// Joins the columns of a grid: completes the blocks at their borders, sets which voxels are
/// active, and makes tiles where all is 1. Empties `columns`. The grid's index 0 lies at the
/// world's origin.
openvdb::FloatGrid::Ptr assembleGrid(std::vector<ColumnBlocks>& columns,
                                     const AssemblyOptions& options);

}  // namespace bandvox
