#pragma once

#include "voxelize/voxel_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/voxelize/voxels.h>

#include <string>
#include <vector>

namespace bandvox {

/// Joins the columns of a lattice, in its order, to a grid, and empties them. `source` is what
/// they were made from. Throws Error(ErrorKind::Result) if no voxel is inside.
VoxelResult assembleVoxels(const std::string& source, const VoxelLattice& lattice,
                           std::vector<ColumnVoxels>& columns);

}  // namespace bandvox
