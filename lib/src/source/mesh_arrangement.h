#pragma once

#include "source/triangle_meetings.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <cstddef>
#include <vector>

namespace bandvox {

/// A mesh whose triangles have nothing in common but corners and edges.
struct MeshArrangement {
    Mesh mesh;
    /// How many triangles of the original lie on each, facing as it does, less those that face the
    /// other way: at least 1.
    std::vector<int> layers;
    std::size_t trianglesCut = 0;  ///< of the original
};

/// Cuts the triangles of a mesh along the lines where they meet. `meetings`: what findMeetings
/// finds for it. Triangles that cover each other become one, or none where they face opposite ways;
/// those without area go. The cuts are computed exactly, their points then rounded, alike in all
/// triangles that share them: so a closed mesh stays closed. Throws Error(ErrorKind::Interrupted).
MeshArrangement arrangeMesh(Mesh mesh, const std::vector<TriangleMeeting>& meetings,
                            Progress& progress);

}  // namespace bandvox
