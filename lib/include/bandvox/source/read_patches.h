#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/bezier_patch.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

/// True of files of free-form surfaces, by their names: .bpt, and those of cadExtensions(). An .obj
/// may hold a mesh, and is looked into. Throws Error(ErrorKind::Input) if that cannot be read.
bool isPatchFile(const std::filesystem::path& path);

/// True if a file of this name is one of a program for constructions.
bool isCadFile(const std::filesystem::path& path);

/// Their extensions: ".step", ".stp", ".iges", ".igs", ".brep".
const std::vector<std::string>& cadExtensions();

/// True if an .obj file has a free-form surface.
bool hasFreeForm(const std::filesystem::path& obj);

/// Reads Bézier and B-spline surfaces.
///
/// .bpt: Newell's format, the number of patches, and for each of them its two degrees and the
/// control points, row by row. .obj: Wavefront's free-form surfaces of cstype bezier and bspline,
/// rational or not; faces and curves are left out with a warning.
///
/// .step, .stp, .iges, .igs, .brep: the faces of solids and shells, each the surface that it lies
/// on, as rational patches, and the loops that trim it; millimetres, but for .brep, which has no
/// unit. Surfaces at a distance of others are approximated. Needs a build with Open CASCADE.
///
/// Throws Error(ErrorKind::Input), naming the line, for what is malformed, truncated, trimmed, of
/// degree 0 or with a weight that is not above 0.
PatchModel readPatches(const std::filesystem::path& path, Progress& progress = silentProgress());

}  // namespace bandvox
