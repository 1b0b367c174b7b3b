#pragma once

#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>
#include <bandvox/voxelize/voxels.h>

#include <string>

namespace bandvox {

/// Draws patches, six vertices for each.
///
/// Uniforms: `size`, of the target in pixels; `plane`, patches that lie before it are left out.
std::string patchVertexShader();

/// Finds which row of a patch its triangle crosses, and where, as LatticeMesh does.
///
/// Uniforms: `first`, the tile's first sample, of Bits also `depth` (samples along x) and
/// `columns` (along z); of Slices `plane`, a sample's x.
std::string crossingFragmentShader(ScanAxis axis, GpuMethod method);

}  // namespace bandvox
