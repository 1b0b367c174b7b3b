#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/boundary_source.h>

#include <cstdint>
#include <filesystem>

namespace bandvox {

/// Where a density goes whose values need not be in memory all at once.
struct VdbTarget {
    std::filesystem::path file;    ///< a .vdb file; beside it, room is taken for values: without a
                                   ///< name, 2 KB for each leaf node, given back in the end
    VdbWriteOptions write;         ///< `half`: values are rounded, as roundAndRestate does
    std::int64_t memoryLimit = 0;  ///< bytes that the process is to hold at most, its libraries and
                                   ///< the source among them; 0 for no limit
};

/// Makes the density of surfaceToDensity, within a limit of memory: columns of tiles are filled in
/// parts, and values that no later part has a share of go to the disk. The grid is the same,
/// whatever the limit, and so is the file that writeVdb makes of it.
///
/// Of the result's grid the tree's nodes, tiles, active states and metadata are in memory. Unless
/// all fitted, the values of its leaf nodes are not: they read as 0, and are not to be changed.
/// What it is for is writeVdb. Metadata of it and of its copies may be changed. Throws as
/// surfaceToDensity; Error(ErrorKind::Memory) also if the limit is too low, before the work as far
/// as that can be told, Error(ErrorKind::Usage) for a part of the grid (DensityOptions::shard),
/// Error(ErrorKind::Runtime) if there is no room on the disk.
DensityResult surfaceToSpooledDensity(const BoundarySource& source, const DensityOptions& options,
                                      const VdbTarget& target,
                                      Progress& progress = silentProgress());

/// The same, and writes it to the target, whole or not at all. Of what is returned the grid is as
/// above. Throws as surfaceToSpooledDensity and writeVdb.
DensityResult surfaceToVdb(const BoundarySource& source, const DensityOptions& options,
                           const VdbTarget& target, Progress& progress = silentProgress());

}  // namespace bandvox
