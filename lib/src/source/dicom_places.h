#pragma once

#include "core/dicom_files.h"

#include <openvdb/Types.h>
#include <openvdb/math/Mat4.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

/// A frame of a file.
struct DicomSlice {
    std::filesystem::path file;
    int frame = 0;
    int frames = 1;  ///< of the file
    DicomFrame place;

    /// For messages.
    std::string name() const;
};

/// Brings slices into the order of their places along the normal of the images, and returns the
/// matrix from the index of a voxel (column, row, slice) to its centre, acting on rows, in mm. The
/// step from slice to slice is that of their places, along the normal or not (a tilted gantry).
/// `step` is what the files say of it, in case that there is one slice only; 0 if they do not.
///
/// Throws Error(ErrorKind::Input), naming files and numbers, if a slice has no place, if slices
/// are turned or spaced differently, lie at the same place, are missing or in uneven steps.
openvdb::Mat4d orderByPlace(std::vector<DicomSlice>& slices, double step);

}  // namespace bandvox
