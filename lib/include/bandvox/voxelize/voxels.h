#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bandvox {

/// The lattice on which a solid is voxelized. Voxel i's centre lies at i · (voxel size) in the
/// world.
struct VoxelOptions {
    int resolution = 256;  ///< voxels along the longest side of the source's box; 1 to 2^20
    double voxelSize = 0;  ///< world units; if > 0 it is used instead of `resolution`
};

/// Binary voxels, and what was counted while they were made.
struct VoxelResult {
    openvdb::FloatGrid::Ptr grid;       ///< named "density": 1 inside, else 0 and not active
    std::int64_t voxels = 0;            ///< inside
    std::vector<std::string> warnings;  ///< in words, for the user
};

}  // namespace bandvox
