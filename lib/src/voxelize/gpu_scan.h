#pragma once

#include "voxelize/bit_column.h"
#include "voxelize/voxel_lattice.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>
#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bandvox {

/// How much the GPU is given to do at once. What the device allows may be less.
struct GpuLimits {
    int side = 8192;                                   ///< rows along a tile's side, at least 16
    std::int64_t bufferBytes = std::int64_t(1) << 27;  ///< for the bits of a tile; at least 2^9
    std::int64_t patches = 1 << 18;                    ///< drawn by one call
};

/// Columns [begin, end) along y and z of a lattice of samples, as places of blocks, and their bits,
/// z first.
struct ScannedTile {
    openvdb::Coord begin, end;  ///< x does not matter
    std::vector<BitColumn> columns;

    const BitColumn& column(const openvdb::Coord& block) const {
        return columns[static_cast<std::size_t>(block.y() - begin.y()) * (end.z() - begin.z()) +
                       (block.z() - begin.z())];
    }
};

/// Scans a mesh by OpenGL, on a lattice of samples, tile by tile; a tile's sides are even numbers
/// of columns. Gives each to `take`, in which no OpenGL may be used. Returns the device's name.
/// Throws as meshToVoxelsOnGpu does.
std::string scanOnGpu(const Mesh& mesh, const VoxelLattice& samples, GpuMethod method,
                      const GpuLimits& limits, Progress& progress,
                      const std::function<void(const ScannedTile&)>& take);

}  // namespace bandvox
