#pragma once

#include "source/point_lists.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <cstddef>

namespace bandvox {

/// What stitchCracks did.
struct StitchedCracks {
    std::size_t pointsJoined = 0;  ///< that fell together with another across a crack
    std::size_t edgesSplit = 0;    ///< at points of other triangles that lie on them: T-junctions
    PointLists edges;              ///< of the mesh that is left, as listEdges has them
};

/// Closes cracks between triangles, as far as they are no wider than `tolerance` (world units):
/// points on the mesh's boundary that are near each other become one, and boundary edges are split
/// where other boundary points lie on them. Points move by no more than the tolerance; edges
/// shorter than it may collapse, and triangles with them. Throws Error(ErrorKind::Interrupted).
StitchedCracks stitchCracks(Mesh& mesh, double tolerance, Progress& progress = silentProgress());

}  // namespace bandvox
