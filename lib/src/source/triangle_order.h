#pragma once

#include <bandvox/source/mesh.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// The triangles of a mesh, by their indices, along a curve that fills its box, so that those that
/// follow each other are near each other. The order depends on the mesh alone.
std::vector<std::uint32_t> orderAlongCurve(const Mesh& mesh);

}  // namespace bandvox
