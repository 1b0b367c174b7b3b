#pragma once

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// A type of number that arrays and images are written with.
enum class VoxelType { UInt8, UInt16, Int16, Half, Float, Double };

/// "uint8", "uint16", "int16", "half", "float", "double", in the order of VoxelType.
const std::vector<std::string>& voxelTypeNames();

/// Which voxels of a grid become an array, and of what type.
struct VoxelsToWrite {
    /// Default: that of the array which the grid was made from, else that of the active voxels.
    std::optional<openvdb::CoordBBox> box;
    VoxelType type = VoxelType::Float;
    /// Of types of whole numbers: the values that become 0 and the largest one, the first below the
    /// second. Default: values stay as they are and are rounded.
    std::optional<std::array<double, 2>> range;
};

/// What was written.
struct WrittenVoxels {
    openvdb::CoordBBox box;    ///< in voxels of the grid
    double minimum = 0;        ///< of the values in it, before they became another type
    double maximum = 0;        ///< the same
    std::int64_t count = 0;    ///< of voxels
    std::int64_t clipped = 0;  ///< values that the type cannot hold, and that became its
                               ///< largest or smallest; beyond a range by more than 0.001 of it
    std::int64_t rounded = 0;  ///< values that stayed as they are, but were no whole numbers
};

/// What writing these voxels would give, without writing: for outputs of several files, which are
/// to be written all or none. Throws as writeArray.
WrittenVoxels examineVoxels(const openvdb::FloatGrid& grid, const VoxelsToWrite& voxels = {},
                            Progress& progress = silentProgress());

/// A format of arrays.
enum class ArrayFormat {
    Npy,       ///< [x][y][z] in C order; it cannot say where voxels lie
    Nrrd,      ///< with space directions and origin
    MetaImage  ///< with spacing, orientation and offset
};

/// How an array is written.
struct ArrayWriteOptions {
    VoxelsToWrite voxels;
    bool compress = false;  ///< gzip in NRRD, zlib in MetaImage; not for .npy
};

/// Writes the voxels of a box to a file that the caller commits, eight slices at a time; where
/// nothing is stored, the background. `values`: null if the values are to follow the header in
/// `file`, else the file for them (.nhdr and .mhd), which has to be in the same folder.
///
/// Throws Error(ErrorKind::Usage) if the format cannot hold the type, for a range or a box that is
/// none, Error(ErrorKind::Result) if the box is empty, Error(ErrorKind::Input) if the transform is
/// not linear, Error(ErrorKind::Memory), Error(ErrorKind::Runtime) if it cannot be written,
/// Error(ErrorKind::Interrupted).
WrittenVoxels writeArray(AtomicFile& file, AtomicFile* values, ArrayFormat format,
                         const openvdb::FloatGrid& grid, const ArrayWriteOptions& options = {},
                         Progress& progress = silentProgress());

}  // namespace bandvox
