#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bandvox {

/// Along which axis of the grid the rows of voxels lie that a solid is scanned by.
enum class ScanAxis { X, Y, Z };

/// The lattice on which a solid is voxelized, and what is asked of a voxel. Voxel i's centre lies
/// at i · (voxel size) in the world. Eight sub-samples lie at i ± 1/4, the centres of its octants.
struct VoxelOptions {
    int resolution = 256;   ///< voxels along the longest side of the source's box; 1 to 2^20
    double voxelSize = 0;   ///< world units; if > 0 it is used instead of `resolution`
    int threshold = 0;      ///< sub-samples that have to be inside, 1 to 8; 0: its centre instead
    bool fraction = false;  ///< values are the share of sub-samples inside; with threshold 0 only
    ScanAxis axis = ScanAxis::X;  ///< of the rows; voxels of a closed mesh do not depend on it

    bool subSamples() const { return threshold > 0 || fraction; }
};

/// Voxels, and what was counted while they were made.
struct VoxelResult {
    openvdb::FloatGrid::Ptr grid;       ///< named "density": 1 inside, else 0 and not active
    std::int64_t voxels = 0;            ///< active: inside, or in part inside
    double volume = 0;                  ///< sum of the values times a voxel's volume, world units³
    std::string device;                 ///< OpenGL's name for what made them; empty: this program
    std::vector<std::string> warnings;  ///< in words, for the user
};

/// The voxels of a grid that are inside (active and at least 0.5) as a mask named "mask": true and
/// active there, false elsewhere. Transform and metadata are the grid's.
openvdb::BoolGrid::Ptr voxelsToMask(const openvdb::FloatGrid& voxels);

/// The voxels of a mask as a grid like VoxelResult's: 1 where the mask is active.
openvdb::FloatGrid::Ptr maskToVoxels(const openvdb::BoolGrid& mask);

}  // namespace bandvox
