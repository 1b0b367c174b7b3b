#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <cstddef>

namespace bandvox {

/// Copies the voxels of a box, a leaf at a time: (x, y, z), counted from the box's first voxel,
/// goes to to[x·planePitch + y·rowPitch + z]. Returns true if all are the same.
bool copyBox(const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& from,
             const openvdb::CoordBBox& box, float* to, std::size_t planePitch,
             std::size_t rowPitch);

}  // namespace bandvox
