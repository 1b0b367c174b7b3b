#pragma once

#include <openvdb/openvdb.h>

#include <optional>
#include <string>

namespace bandvox {

/// The whole number of voxels between two lattices that have the same voxels: voxel x of `first`
/// is voxel x + offset of `other`. Nothing if voxels have other sides or directions, by more than
/// 1e-6 of a side, if they lie between each other by more than that (of the offset, where that is
/// larger), or if a transform is not linear.
std::optional<openvdb::Coord> wholeVoxelOffset(const openvdb::math::Transform& first,
                                               const openvdb::math::Transform& other);

/// What keeps wholeVoxelOffset from being a number, in words, with what each of them has; empty if
/// nothing does.
std::string latticeDifference(const openvdb::math::Transform& first,
                              const openvdb::math::Transform& other);

}  // namespace bandvox
