#pragma once

#include <bandvox/source/mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// Turns those pieces of a mesh that look the wrong way: more often than not, a ray from the front
/// of their largest triangles crosses the mesh an odd number of times, and one from the back an
/// even number. Unlike a winding number, this does not mind how the other pieces are turned.
///
/// K. Takayama, A. Jacobson, L. Kavan, O. Sorkine-Hornung: "A Simple Method for Correcting Facet
/// Orientations in Polygon Meshes Based on Ray Casting" (2014), section 3.1. Of many pieces some
/// are asked first, and if hardly any looks the wrong way, nothing is done. `pieceOf`: of each
/// triangle; `isWanted`: of each piece, whether it may be turned; `own`: the triangles that rays
/// may hit are those before it, caps coming after. Returns how many of those were flipped.
std::size_t orientByRays(Mesh& mesh, const std::vector<std::uint32_t>& pieceOf,
                         const std::vector<char>& isWanted, std::size_t own);

}  // namespace bandvox
