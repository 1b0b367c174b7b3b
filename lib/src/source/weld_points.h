#pragma once

#include <bandvox/source/mesh.h>

#include <cstddef>

namespace bandvox {

/// Removes points that no triangle uses.
void removeUnusedPoints(Mesh& mesh);

/// Makes points that are equal, or nearer than `tolerance` (world units), one; the first of them
/// stays, in the order they had.
/// Returns how many points fell together with another.
std::size_t weldPoints(Mesh& mesh, double tolerance);

}  // namespace bandvox
