#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/mesh/surface_mesh.h>

#include <cstddef>

namespace bandvox {

/// How points of a mesh are left out.
struct CollapseOptions {
    double tolerance = 0;   ///< farthest that the surface may come from where it was, world units
    double regionSide = 1;  ///< of the cubes that are worked on at the same time, world units
};

/// Leaves points out of a closed manifold mesh, which stays one: a point is moved onto a neighbour,
/// which takes its triangles over. What stays is where it was. For each triangle is kept how far it
/// may be from the surface that it stands for, and a collapse adds to that how far it moves the
/// surface. Triangles turn no more than their points' normals allow. Returns how many points were
/// left out. The same for any number of threads.
///
/// After H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle: "Mesh Optimization" (1993), for
/// which collapses keep a mesh what it is.
std::size_t collapsePoints(SurfaceMesh& surface, const CollapseOptions& options,
                           Progress& progress);

}  // namespace bandvox
