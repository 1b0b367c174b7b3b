#pragma once

#include "source/point_lists.h"

#include <bandvox/source/mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// An edge on the boundary of a piece, in the direction in which the piece's triangles have it.
struct BoundaryEdge {
    std::uint32_t component;
    std::uint32_t from, to;
};

/// The connected pieces of a mesh.
struct MeshComponents {
    std::size_t count = 0;
    std::vector<std::uint32_t> ofTriangle;  ///< the piece of each triangle
    std::vector<BoundaryEdge> boundary;     ///< directed edges of a piece that lack an opposite,
                                            ///< by component and start
    std::size_t trianglesFlipped = 0;       ///< to agree with their neighbours
    std::size_t nonManifoldEdges = 0;       ///< edges of more than two triangles
    std::vector<std::uint32_t> oneSided;    ///< pieces that cannot be oriented
};

/// Splits a mesh into pieces connected across edges of exactly two triangles, and turns the
/// triangles of each piece to agree, flipping the fewer of them. `lists`:
/// the mesh's edges, as listEdges has them.
MeshComponents orientComponents(Mesh& mesh, const PointLists& lists);

}  // namespace bandvox
