#pragma once

#include "render/solid_voxels.h"

#include <openvdb/Types.h>

namespace bandvox {

// Normals of solid voxels, from the voxels around. All in index coordinates, of any length; they
// turn into the world as gradients do.

/// The face's own.
openvdb::Vec3d faceNormal(const VoxelHit& hit);

/// At each corner of the face the mean of the normals of all faces between solid and empty voxels
/// that meet there; between the corners, at `place` on the face, interpolated bilinearly. Where
/// they cancel out, the face's own.
///
/// L. Chen, G. Herman, R. Reynolds, J. Udupa: "Surface Shading in the Cuberille Environment"
/// (1985); B. Phong: "Illumination for Computer Generated Pictures" (1975).
openvdb::Vec3d phongNormal(const VoxelHit& hit, const openvdb::Vec3d& place,
                           const SolidVoxels::Probe& probe);

/// Sobel's operator in three dimensions on the voxels around the one that was hit: differences
/// along an axis, weighted by 1, 2, 1 along both others. Where it is 0, the face's normal.
openvdb::Vec3d sobelNormal(const VoxelHit& hit, const SolidVoxels::Probe& probe);

}  // namespace bandvox
