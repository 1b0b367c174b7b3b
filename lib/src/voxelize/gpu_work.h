#pragma once

#include "voxelize/gpu_scan.h"

#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>

namespace bandvox {

/// What the public function does, with limits that tests can set.
struct GpuWork {
    GpuMethod method = GpuMethod::Bits;
    GpuLimits limits = {};
};

VoxelResult meshToVoxelsOnGpu(const MeshSource& source, const VoxelOptions& options,
                              const GpuWork& work, Progress& progress);

}  // namespace bandvox
