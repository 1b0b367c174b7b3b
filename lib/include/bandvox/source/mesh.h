#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace bandvox {

/// Triangles over shared points. Nothing is promised about orientation or closedness.
struct Mesh {
    std::vector<openvdb::Vec3d> points;     ///< world units
    std::vector<openvdb::Vec3I> triangles;  ///< indices into points, counter-clockwise from outside
};

}  // namespace bandvox
