#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace bandvox {

/// Triangles over the points of a closed loop, by their places in it, each of which runs along the
/// loop: first < second < third. Together they are the surface of least area, and least bent, among
/// those that a Delaunay tetrahedralization of the points has, or of all for short loops. Empty if
/// there is none, as for points that coincide. CGAL, after P. Liepa: "Filling Holes in Meshes"
/// (2003).
std::vector<openvdb::Vec3I> triangulateLoop(const std::vector<openvdb::Vec3d>& loop);

}  // namespace bandvox
