#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <cstddef>
#include <optional>

namespace bandvox {

/// Copies the voxels of a box, a leaf at a time: (x, y, z), counted from the box's first voxel,
/// goes to to[x·planePitch + y·rowPitch + z]. Returns true if all are the same.
bool copyBox(const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& from,
             const openvdb::CoordBBox& box, float* to, std::size_t planePitch,
             std::size_t rowPitch);

/// The value of all voxels of a box, 128 or fewer along each side, that lies in tiles of 128³
/// voxels or more with one value; nothing if it does not. Looks at eight voxels only.
std::optional<float> valueOfLargeTiles(
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& from,
    const openvdb::CoordBBox& box);

}  // namespace bandvox
