#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/voxelize/voxels.h>

namespace bandvox {

/// Turns the solid inside a closed mesh into voxels: those whose centres are inside, or enough of
/// whose sub-samples. Each row of samples along an axis is scan converted: the triangles that it
/// meets are found, and their crossings summed up to a winding number; a positive one is inside, so
/// shells that overlap form a union.
///
/// Points are rounded to 2^-17 voxels (or sub-samples); all that follows is whole-number
/// arithmetic. A sample that lies on the surface counts as the place next to it towards +x; where
/// that is on the surface too, towards +y, then +z. So there are no cracks, solids that share a
/// face share no voxel, and the axis makes no difference.
///
/// The grid is a fog volume with a background of 0; whole nodes inside are active tiles of 1.
/// Throws Error(ErrorKind::Usage) for options out of range or voxels too small for the object,
/// Error(ErrorKind::Memory) before allocating if it would not fit, Error(ErrorKind::Input) if the
/// mesh is not closed, Error(ErrorKind::Result) if nothing is inside,
/// Error(ErrorKind::Interrupted).
VoxelResult meshToVoxels(const MeshSource& source, const VoxelOptions& options = {},
                         Progress& progress = silentProgress());

}  // namespace bandvox
