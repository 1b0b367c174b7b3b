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
                           const VoxelOptions& options, std::vector<ColumnVoxels>& columns);

/// The same of the columns of a mesh. Throws Error(ErrorKind::Input) if it is not closed; warns of
/// what is inside out.
VoxelResult assembleMeshVoxels(const std::string& source, const VoxelLattice& lattice,
                               const VoxelOptions& options, std::vector<ColumnVoxels>& columns);

}  // namespace bandvox
