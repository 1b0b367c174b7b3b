#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/field_source.h>
#include <bandvox/voxelize/voxels.h>

namespace bandvox {

/// Turns a field into voxels: those at whose centres, or enough of whose sub-samples, it is at
/// least 0.5. It is sampled row by row, once for each sample in its box.
///
/// The grid is as meshToVoxels makes it. Throws Error(ErrorKind::Usage) for options out of range
/// or voxels too small for the field's box, Error(ErrorKind::Memory) before allocating if a solid
/// that fills the box would not fit, Error(ErrorKind::Input) if the box has no size,
/// Error(ErrorKind::Result) if nothing is inside, Error(ErrorKind::Interrupted).
VoxelResult fieldToVoxels(const FieldSource& source, const VoxelOptions& options = {},
                          Progress& progress = silentProgress());

}  // namespace bandvox
