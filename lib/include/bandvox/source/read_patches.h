#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/bezier_patch.h>

#include <filesystem>

namespace bandvox {

/// True if a file of this name may hold free-form surfaces: .bpt, and .obj.
bool mayHoldPatches(const std::filesystem::path& path);

/// True if an .obj file has a free-form surface.
bool hasFreeForm(const std::filesystem::path& obj);

/// Reads Bézier and B-spline surfaces.
///
/// .bpt: Newell's format, the number of patches, and for each of them its two degrees and the
/// control points, row by row. .obj: Wavefront's free-form surfaces of cstype bezier and bspline,
/// rational or not; faces and curves are left out with a warning.
///
/// Throws Error(ErrorKind::Input), naming the line, for what is malformed, truncated, trimmed, of
/// degree 0 or with a weight that is not above 0.
PatchModel readPatches(const std::filesystem::path& path, Progress& progress = silentProgress());

}  // namespace bandvox
