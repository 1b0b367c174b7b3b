#pragma once

#include <bandvox/source/patch_solid.h>

#include <string>

namespace bandvox {

/// The solid within shells of trimmed faces, which are sampled up to their loops. Throws
/// Error(ErrorKind::Result) for shells that are open, and for those that enclose nothing.
PatchSolid makeFaceSolid(const std::string& name, PatchModel model, Progress& progress);

}  // namespace bandvox
