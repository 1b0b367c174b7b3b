#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <cstddef>
#include <string>
#include <vector>

namespace bandvox {

/// What was found where shells meet, and what was done about it.
struct UnionReport {
    std::size_t meetings = 0;           ///< pairs of triangles that cut, touch or cover each other
    std::size_t trianglesCut = 0;       ///< of the mesh, along the lines where they meet
    std::size_t trianglesDropped = 0;   ///< or pieces of them: inside, or bounding nothing
    std::vector<std::string> warnings;  ///< in words, for the user
};

/// The outside of a solid, and how it came about.
struct UnitedMesh {
    Mesh mesh;  ///< closed; bounds what was wound around once at least
    UnionReport report;
};

/// Makes the union of the shells of a closed mesh, as closeMesh leaves it: of shells that overlap,
/// lie within each other or pass through themselves only what bounds the solid stays, so there are
/// no walls inside. A place is in the solid if the surface winds around it at least once; cavities,
/// which it winds around once less than what holds them, stay.
///
/// Triangles are cut along the lines where they meet, in exact arithmetic; the cuts' points are
/// then rounded to doubles, alike on both sides. A mesh whose shells do not meet comes back as it
/// was, without shells that lie within others. Cost is that of finding what meets, about that of
/// sorting the triangles, and of what does. A. Zhou, E. Grinspun, D. Zorin, A. Jacobson: "Mesh
/// Arrangements for Solid Geometry" (2016). Throws Error(ErrorKind::Result) if nothing is left,
/// Error(ErrorKind::Memory) if too many triangles meet, Error(ErrorKind::Interrupted).
UnitedMesh uniteShells(Mesh mesh, Progress& progress = silentProgress());

}  // namespace bandvox
