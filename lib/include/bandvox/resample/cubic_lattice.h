#pragma once

#include <openvdb/openvdb.h>

namespace bandvox {

/// True if the voxels of a lattice are cubes, to 1e-6 of a side and as much of an angle.
bool hasCubicVoxels(const openvdb::math::Transform& lattice);

/// The lattice of cubes of this side, world units, along a grid's axes; of axes that are no right
/// angle apart the second and the third are as near to them as can be. Throws as uniformLattice.
openvdb::math::Transform::Ptr cubicLattice(const openvdb::GridBase& grid, double side);

}  // namespace bandvox
