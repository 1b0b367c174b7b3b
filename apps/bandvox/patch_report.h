#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/bezier_patch.h>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace bandvox::app {

/// What a file of free-form surfaces holds, and what would be done to make it a solid.
///
/// Keys: file, file_bytes (null of a pipe), patches, faces (trimmed ones, of parts), objects (their
/// names), bounds ({min, max}, world, of the solid's surface; without a solid of the control
/// points, which enclose it), pieces, patches_flipped, pieces_turned, sides_shared_by_more (than
/// two patches),
/// pieces_meeting (that others may run into), holes ([{edges, perimeter, center}], largest first),
/// area and volume (world, of the solid that comes of it; null if none does), closed (true if
/// nothing had to be capped, and every side is one of two patches), warnings, and problem (why no
/// solid comes of it, else null). Throws Error(ErrorKind::Input) if the file cannot be read.
nlohmann::ordered_json patchReport(const std::string& input, Progress& progress);

/// The same of patches that have been read, without file and file_bytes; problems call them `name`.
nlohmann::ordered_json patchReport(PatchModel model, Progress& progress,
                                   const std::string& name = "model");

/// The same for people.
std::string patchReportInWords(const nlohmann::ordered_json& report);

}  // namespace bandvox::app
