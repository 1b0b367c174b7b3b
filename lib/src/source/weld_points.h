#pragma once

#include <bandvox/source/mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// Removes points that no triangle uses.
void removeUnusedPoints(Mesh& mesh);

/// Makes points that are equal, or nearer than `tolerance` (world units), one; the first of them
/// stays, in the order they had.
/// Returns how many points fell together with another.
std::size_t weldPoints(Mesh& mesh, double tolerance);

/// Removes triangles with two equal corners. Returns how many there were.
std::size_t dropCollapsed(Mesh& mesh);

/// What weldPoints does, for points alone. Returns the number that each of them has among those
/// that are left.
std::vector<std::uint32_t> weld(std::vector<openvdb::Vec3d>& points, double tolerance);

}  // namespace bandvox
