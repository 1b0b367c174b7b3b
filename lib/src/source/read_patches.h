#pragma once

#include "source/file_integrity.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/bezier_patch.h>

namespace bandvox {

PatchModel readBptPatches(const FileContents& file, Progress& progress);
PatchModel readObjPatches(const FileContents& file, Progress& progress);
PatchModel readCadPatches(const std::filesystem::path& path, Progress& progress);

}  // namespace bandvox
