#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>

#include <filesystem>

namespace bandvox::python {

/// What bandlimit makes of a mesh file or a built-in shape, by the route that fits. Without the
/// interpreter's lock. Throws as bandlimit does.
DensityResult densityOfSolid(const std::filesystem::path& path, const DensityOptions& options,
                             Progress& progress);

}  // namespace bandvox::python
