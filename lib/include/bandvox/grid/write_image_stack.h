#pragma once

#include <bandvox/grid/write_array.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace bandvox {

/// How a stack of images is written.
struct ImageStackOptions {
    VoxelsToWrite voxels;
    bool compress = true;  ///< without loss; PNG always is
};

/// True if the name ends in .tif, .tiff, .png or .exr.
bool isWritableImage(const std::filesystem::path& path);

/// True if the name has a place for the number of a slice, "out.####.png" or "out%04d.png".
bool isImagePattern(const std::filesystem::path& path);

/// The type that images of this name get if none is asked for: uint16 of .png, else float.
VoxelType usualImageType(const std::filesystem::path& path);

/// Throws Error(ErrorKind::Usage) if images of this name cannot hold the type, or if there is
/// neither a place for a number nor a format with pages, which is .tif.
void requireImageType(const std::filesystem::path& path, VoxelType type);

/// The file of a slice, counted from 0, for a pattern.
std::filesystem::path sliceFile(const std::filesystem::path& pattern, int slice);

/// Writes the slices of a box to files named by a pattern, slice 0 the one of least z; rows are
/// along x, columns along y, downwards. Each file appears whole or not at all; an interruption
/// leaves those that were done. TIFF files say how large voxels are, as ImageJ does.
///
/// Throws as writeArray, and Error(ErrorKind::Runtime) if there are files of the pattern already
/// with numbers beyond the last slice: they would pass for slices.
WrittenVoxels writeImageStack(const std::filesystem::path& pattern, const openvdb::FloatGrid& grid,
                              const ImageStackOptions& options = {},
                              Progress& progress = silentProgress());

/// Writes them as the pages of one .tif file, which the caller commits.
WrittenVoxels writeImagePages(AtomicFile& file, const openvdb::FloatGrid& grid,
                              const ImageStackOptions& options = {},
                              Progress& progress = silentProgress());

}  // namespace bandvox
