#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/spline_volume.h>

#include <string>
#include <vector>

namespace bandvox {

/// Columns of a volume that become a grid.
struct ColumnGrid {
    std::string name;
    int column = 0;   ///< the first of them
    int columns = 1;  ///< 1: a grid of floats, or a gradient; 3: of vectors of floats
    openvdb::VecType type = openvdb::VEC_INVARIANT;  ///< of the vectors
    /// The gradient of one column, per world unit, as vectors.
    bool isGradient = false;
};

/// Samples a volume on a lattice: the centres of voxels are at whole multiples of `voxelSize`,
/// world units, above 0. Voxels within reach of a point are active; all others have the background,
/// 0. The result does not depend on the number of threads.
///
/// Throws Error(ErrorKind::Usage) for columns that are not there, Error(ErrorKind::Result) if no
/// voxel is within reach, Error(ErrorKind::Memory) if there are too many,
/// Error(ErrorKind::Interrupted).
openvdb::GridPtrVec splineVolumeToGrids(const SplineVolume& volume,
                                        const std::vector<ColumnGrid>& grids, double voxelSize,
                                        Progress& progress = silentProgress());

}  // namespace bandvox
