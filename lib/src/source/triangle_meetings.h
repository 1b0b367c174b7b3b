#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// Two triangles of a mesh, by their indices, that have more in common than corners and edges.
struct TriangleMeeting {
    std::uint32_t first, second;  ///< first < second
    bool coplanar;                ///< and overlap in an area
};

/// Finds the triangles of a mesh that cut, touch or cover each other, in rising order. Exact: the
/// answers do not depend on rounding. Triangles without area meet all that they touch, even at a
/// corner. Throws Error(ErrorKind::Memory) if they are too many, Error(ErrorKind::Interrupted).
std::vector<TriangleMeeting> findMeetings(const Mesh& mesh, Progress& progress);

/// True if the corners lie on a line, exactly.
bool hasNoArea(const Mesh& mesh, std::uint32_t triangle);

}  // namespace bandvox
