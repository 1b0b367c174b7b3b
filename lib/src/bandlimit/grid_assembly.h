#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/far_tiles.h"
#include "bandlimit/finish_leaves.h"
#include "bandlimit/tile_plan.h"

#include <vector>

namespace bandvox {

/// Joins the columns of a grid, in the order of the layout's (y, z): completes the blocks at their
/// borders, sets which voxels are active, and makes tiles where all is 1. Empties `columns`. The
/// grid's index 0 lies at the world's origin.
openvdb::FloatGrid::Ptr assembleGrid(std::vector<ColumnBlocks>& columns, const TileLayout& layout,
                                     const AssemblyOptions& options);

/// Adds the tiles of a grid: where all is one whole number other than 0, in far tiles or in blocks.
void addTiles(const FarTiles& far, const std::vector<ConstantBlock>& constant, bool clamp,
              openvdb::FloatTree& tree);

}  // namespace bandvox
