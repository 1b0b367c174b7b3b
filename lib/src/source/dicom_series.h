#pragma once

#include "source/stack_files.h"

#include <bandvox/source/array_source.h>

#include <memory>

namespace bandvox {

/// Opens the frames of DICOM files as slices, in the order of their places along the normal of
/// the images. World units are mm, axes left-posterior-superior. Throws as openArray.
std::unique_ptr<ArraySource> openDicomSeries(StackFiles files, const ArrayReadOptions& options);

}  // namespace bandvox
