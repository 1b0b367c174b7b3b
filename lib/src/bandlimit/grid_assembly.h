#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/tile_plan.h"

#include <vector>

namespace bandvox {

struct AssemblyOptions {
    double threshold;     ///< values nearer to a whole number than this are stored as it
    bool clamp;           ///< limit values to [0, 1]
    bool isPart = false;  ///< there are columns that others fill; of blocks that go on in them
                          ///< what is here is kept
};

/// Joins the columns of a grid, in the order of the layout's (y, z): completes the blocks at their
/// borders, sets which voxels are active, and makes tiles where all is 1. Empties `columns`. The
/// grid's index 0 lies at the world's origin.
openvdb::FloatGrid::Ptr assembleGrid(std::vector<ColumnBlocks>& columns, const TileLayout& layout,
                                     const AssemblyOptions& options);

}  // namespace bandvox
