#pragma once

#include <bandvox/source/mesh.h>

#include <cstddef>

namespace bandvox {

/// Removes triangles that have the same three corners as another.
///
/// Of those that face the same way one stays. Two that face opposite ways bound nothing and
/// both go (a wall between two solids), unless most of the mesh is made of such pairs: then it
/// is a surface with two sides drawn, and one of each pair stays.
/// Returns how many were removed.
std::size_t removeDuplicates(Mesh& mesh);

}  // namespace bandvox
