#pragma once

#include "source/orient_components.h"

#include <bandvox/source/mesh.h>

#include <cstddef>
#include <vector>

namespace bandvox {

/// Pieces that caps do not make solids.
struct SeparatedSoup {
    Mesh soup;  ///< their triangles, without caps, facing outward as far as they tell
    std::size_t pieces = 0;
    std::vector<char> isSoup;          ///< of each piece that there was; empty if none is
    std::size_t sheets = 0;            ///< open pieces that enclose nothing, capped or not
    std::size_t trianglesFlipped = 0;  ///< of all, because rays said so
};

/// Takes those pieces out of a mesh whose holes have just been capped whose caps lie where the
/// winding number of all that is not capped is clearly another than on the caps' sides: so a cap
/// would be a wall within what the pieces enclose together, or leave it empty. Panels of a box that
/// do not touch are such pieces, and shells that were cut up.
///
/// Pieces that are flat may look the wrong way, which confuses the winding number: they are turned
/// first, as rays say.
///
/// `firstCap`: the caps are the triangles from there on. Of large meshes a part of the pieces
/// speaks for all.
SeparatedSoup separateSoup(Mesh& mesh, MeshComponents& components, std::size_t firstCap);

/// Takes all pieces out.
SeparatedSoup separateAll(Mesh& mesh, MeshComponents& components, std::size_t firstCap);

}  // namespace bandvox
