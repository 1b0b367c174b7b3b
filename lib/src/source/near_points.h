#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace bandvox {

/// True if any two of the points are equal or, in world units, no farther apart than `tolerance`.
bool haveNearPoints(const std::vector<openvdb::Vec3d>& points, double tolerance);

}  // namespace bandvox
