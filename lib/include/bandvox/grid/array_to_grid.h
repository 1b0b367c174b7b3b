#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/array_source.h>

#include <openvdb/openvdb.h>

namespace bandvox {

/// How an array becomes a grid.
struct ArrayGridOptions {
    float background = 0;  ///< value of what lies around the array, and of what is not stored
    float tolerance = 0;   ///< values as near to the background as this are it; ≥ 0
};

/// Turns an array into a grid named "density", a slab of slices after the other, so that memory is
/// that of the grid and of eight slices. Voxel (i, j, k) is the array's; the transform is that of
/// the file, whose unit and axes are kept as bandvox_unit and bandvox_space, the array's box as
/// array_box.h has it. Values that are not the background are active. Throws what the source does,
/// Error(ErrorKind::Input) for a value that is not finite, Error(ErrorKind::Memory) where the grid
/// grows beyond what there is, Error(ErrorKind::Interrupted).
openvdb::FloatGrid::Ptr arrayToGrid(ArraySource& source, const ArrayGridOptions& options = {},
                                    Progress& progress = silentProgress());

}  // namespace bandvox
