#pragma once

#include "source/stack_files.h"

#include <bandvox/source/array_source.h>

#include <memory>

namespace bandvox {

/// Opens images as slices: one file with pages, or files with one each. Throws as openArray.
std::unique_ptr<ArraySource> openImageStack(StackFiles files, const ArrayReadOptions& options);

}  // namespace bandvox
