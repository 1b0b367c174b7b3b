#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/array_source.h>

#include <openvdb/openvdb.h>

#include <limits>

namespace bandvox {

/// Which values of an array are inside of a solid.
struct ArraySolidOptions {
    double low = 0;                                         ///< inside are values from here
    double high = std::numeric_limits<double>::infinity();  ///< to here
    double outside = 0;  ///< value of what lies around the array; not inside
};

/// Turns an array into a grid that is above 0 where values are inside, and below 0 elsewhere:
///
///     g = min(v - low, high - v),
///
/// so that {g = 0}, read linearly between nodes, is where v crosses a limit, which is what
/// makeGridSurface makes of it. Only blocks of 8³ voxels that the surface passes, or touches, are
/// stored; others are tiles, so that memory is that of the surface and of ten slices. Blocks inside
/// have a positive value that says no more. Voxel (i, j, k) is the array's, the transform that of
/// the file, the name "density". The iso-value to go on with is 0.
///
/// Throws what the source does, Error(ErrorKind::Usage) unless low < high and `outside` is not
/// between them, Error(ErrorKind::Input) for a value that is not finite, Error(ErrorKind::Result)
/// if nothing is inside, Error(ErrorKind::Memory) where the grid grows beyond what there is,
/// Error(ErrorKind::Interrupted).
openvdb::FloatGrid::Ptr arrayToSolidGrid(ArraySource& source, const ArraySolidOptions& options,
                                         Progress& progress = silentProgress());

}  // namespace bandvox
