#pragma once

#include <openvdb/openvdb.h>

#include <optional>

namespace bandvox {

/// The colours of an object between the nodes of their grid.
class ObjectColors {
  public:
    /// Throws Error(ErrorKind::Input) if its transform is not linear, or a colour is not finite or
    /// above 1e6. What is below 0 counts as 0.
    explicit ObjectColors(openvdb::Vec3SGrid::ConstPtr grid);

    /// The colour at a place, world units: the mean of the active nodes of its cell, weighted
    /// trilinearly. Nothing where none of them is active.
    std::optional<openvdb::Vec3d> at(const openvdb::Vec3d& place) const;

  private:
    openvdb::Vec3SGrid::ConstPtr mGrid;
    openvdb::Mat4d mToIndex;
};

}  // namespace bandvox
