#pragma once

#include "source/directed_edges.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// Which triangles of a mesh are neighbours, across edges that exactly two of them have.
struct TriangleNeighbors {
    std::vector<std::uint32_t> mate;  ///< of each directed edge the other's, or kNoIndex
    std::size_t crowdedEdges = 0;     ///< edges of more than two triangles
    bool agree = true;  ///< all neighbours run along their edge in opposite directions
};

/// `lists`: those of listEdges.
TriangleNeighbors findNeighbors(const DirectedEdges& edges, const PointLists& lists);

/// Sets of triangles that are connected by neighbours.
struct ConnectedTriangles {
    std::vector<std::uint32_t> setOf;  ///< of each triangle, in the order of their first ones
    std::size_t count = 0;
};

ConnectedTriangles connectNeighbors(const TriangleNeighbors& neighbors);

}  // namespace bandvox
