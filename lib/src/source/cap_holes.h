#pragma once

#include "source/orient_components.h"

#include <bandvox/source/close_mesh.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// A hole, and the piece that it was one of.
struct HoleOfPiece {
    std::uint32_t piece;
    CappedHole hole;
};

/// Closes each boundary loop of each piece by a surface of little area (a loop of three edges by
/// one triangle). The new triangles are added to their pieces, after all others.
std::vector<HoleOfPiece> capHoles(Mesh& mesh, MeshComponents& components);

}  // namespace bandvox
