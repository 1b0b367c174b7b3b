#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <optional>
#include <string>

namespace bandvox {

/// How the solid that a grid stands for is band-limited.
struct GridDensityOptions {
    DensityOptions density;     ///< but for resolution and voxel size, which are the lattice's
    std::optional<double> iso;  ///< the value that is the surface, as GridSurfaceOptions::iso
    std::string source;         ///< what the density says that it was made from
};

/// The band-limited density of the solid of a grid that other programs made, a level set's or
/// fog's, of binary voxels or of a scan: makeGridSurface, and surfaceToDensity on the lattice
/// `target`. What the grid says of its world (PlaceMetadata) the density does, too.
///
/// Throws Error(ErrorKind::Usage) unless the voxels of `target` are cubes (hasCubicVoxels), and as
/// these two.
DensityResult gridToDensity(const openvdb::FloatGrid::ConstPtr& grid,
                            const openvdb::math::Transform& target,
                            const GridDensityOptions& options,
                            Progress& progress = silentProgress());

}  // namespace bandvox
