#pragma once

#include "core/slice_files.h"

#include <bandvox/source/array_source.h>

#include <optional>
#include <string>

namespace bandvox {

/// What the description says that ImageJ puts into a TIFF file.
struct ImageCalibration {
    int images = 1, channels = 1, frames = 1;
    bool hasSpacing = false;
    openvdb::Vec3d spacing{1.0};  ///< of voxels, in units
    std::string unit;             ///< empty if it has no name
};

/// Nothing if the description is not one of ImageJ's.
std::optional<ImageCalibration> readCalibration(const SliceFileInfo& info);

/// The description that makes ImageJ, and readCalibration, know how far slices are apart. The
/// spacing along x and y goes into the resolution.
std::string calibrationText(int images, double sliceStep, const std::string& unit);

}  // namespace bandvox
