#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/read_mesh.h>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace bandvox::app {

/// The health of a mesh file: what it holds, and what would be done to make it a solid.
///
/// Keys: file, file_bytes, points, triangles, objects, bounds ({min, max}, world), pieces,
/// points_welded, triangles_without_area, duplicate_triangles, crack_points, edges_split,
/// triangles_flipped, pieces_turned, one_sided_pieces, non_manifold_edges, holes ([{edges,
/// perimeter, center}], largest first), triangle_meetings (pairs that cut, touch or cover each
/// other), triangles_inside (dropped for the union), area and volume (world, of the solid that
/// comes of it), these four null if none does, closed (true if nothing had to be closed, turned or
/// united), warnings, and problem (why no solid comes of it, else null). Throws
/// Error(ErrorKind::Input) if the file cannot be read.
nlohmann::ordered_json meshReport(const std::string& input, Progress& progress);

/// The same of a mesh that has been read, without file and file_bytes.
nlohmann::ordered_json meshReport(MeshFile file, Progress& progress);

/// The same for people.
std::string meshReportInWords(const nlohmann::ordered_json& report);

}  // namespace bandvox::app
