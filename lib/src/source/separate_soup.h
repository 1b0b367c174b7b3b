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

/// Takes those pieces out of a mesh whose holes have just been capped that are soup: whose caps are
/// large beside the piece, and lie where the winding number, such pieces being left open and all
/// others capped, is clearly another than on the caps' sides. A cap would be a wall within what the
/// pieces enclose together, or leave it empty. Panels of a box that do not touch are such pieces,
/// and shells that were cut up. Other open pieces follow if the soup contradicts their caps.
///
/// Where any may be soup, open pieces are turned outward first: by what they enclose, flat ones as
/// rays say. `firstCap`: the caps are the triangles from there on. Of more than a thousand pieces a
/// part speaks for all.
SeparatedSoup separateSoup(Mesh& mesh, MeshComponents& components, std::size_t firstCap);

/// Takes all pieces out.
SeparatedSoup separateAll(Mesh& mesh, MeshComponents& components, std::size_t firstCap);

}  // namespace bandvox
