#pragma once

#include "source/orient_components.h"

#include <bandvox/source/close_mesh.h>

#include <vector>

namespace bandvox {

/// Closes each boundary loop of each piece by a fan about the mean of its points (a loop of
/// three edges by one triangle). The new triangles are added to their pieces.
/// Returns the loops in order of falling perimeter.
std::vector<CappedHole> capHoles(Mesh& mesh, MeshComponents& components);

}  // namespace bandvox
