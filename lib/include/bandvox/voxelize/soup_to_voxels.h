#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/soup_source.h>
#include <bandvox/voxelize/voxels.h>

namespace bandvox {

/// Turns the places that a soup winds around by more than half, and those in the solid beside it,
/// into voxels. The solid is scanned as meshToVoxels does it; of the soup the winding number is
/// followed along the rows of samples, as SoupSource does it. Rows lie along x, whatever the axis
/// asked for.
///
/// The grid is as meshToVoxels makes it. Throws what that throws for options, memory and solids;
/// Error(ErrorKind::Result) if nothing is inside.
VoxelResult soupToVoxels(const SoupOfTriangles& triangles, const VoxelOptions& options = {},
                         Progress& progress = silentProgress());

}  // namespace bandvox
