#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/resample/resample_grid.h>

#include <openvdb/openvdb.h>

#include <vector>

namespace bandvox {

/// Coarser and coarser copies of a grid: level l, l = 1 to `levels`, has voxels 2^l times as large,
/// voxel 0 in the same place, and is band-limited for them. Each is made of the one before, which
/// for a density of this library is as good as from its source (resampleGrid). Named NAME_level_l
/// and numbered by the metadata MultiResGrid_Level, as OpenVDB's MultiResGrid has it.
///
/// Throws as resampleGrid, and Error(ErrorKind::Usage) unless there are 1 to 16 levels.
std::vector<openvdb::FloatGrid::Ptr> makeDetailLevels(const openvdb::FloatGrid::ConstPtr& grid,
                                                      int levels,
                                                      const ResampleOptions& options = {},
                                                      Progress& progress = silentProgress());

/// The same of vectors, as colours, each level by resampleVectors.
std::vector<openvdb::Vec3SGrid::Ptr> makeDetailLevels(const openvdb::Vec3SGrid::ConstPtr& grid,
                                                      int levels,
                                                      const ResampleOptions& options = {},
                                                      Progress& progress = silentProgress());

/// Says of a grid that it is level `level` of detail of `finest`: by its name, NAME_level_l, and
/// the metadata MultiResGrid_Level.
void nameDetailLevel(openvdb::GridBase& grid, const openvdb::GridBase& finest, int level);

}  // namespace bandvox
