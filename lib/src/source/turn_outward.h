#pragma once

#include "source/orient_components.h"

#include <bandvox/source/mesh.h>

#include <cstddef>

namespace bandvox {

/// What turnOutward did.
struct TurnedComponents {
    std::size_t components = 0;
    std::size_t triangles = 0;
};

/// Turns the closed pieces of a mesh that are inside out. A piece inside others is turned if the
/// outermost of them is, so that cavities stay cavities.
TurnedComponents turnOutward(Mesh& mesh, const MeshComponents& components);

}  // namespace bandvox
