#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>
#include <openvdb/math/Mat4.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bandvox {

/// What a file, or several, say of the array in them.
struct ArrayInfo {
    std::string name;           ///< of the file, the folder or the pattern
    openvdb::Coord size;        ///< along x, y and z; each at least 1
    std::array<int, 3> axes;    ///< the axes in the order of the file, the fastest first
    std::string valueType;      ///< "uint16", "float32", ...
    openvdb::Mat4d toWorld;     ///< from a voxel's index to its centre, acting on rows; world units
    bool hasTransform = false;  ///< the file says where its voxels lie
    std::string unit;           ///< of the world, as "mm"; empty if that is not known
    std::string space;          ///< the axes of the world, as "left-posterior-superior"; empty
                                ///< if it does not say
    std::vector<std::string> notes;  ///< what else a user should know, a sentence each

    std::int64_t valuesPerSlice() const { return std::int64_t(size[axes[0]]) * size[axes[1]]; }
    int slices() const { return size[axes[2]]; }
};

/// A three-dimensional array of numbers in a file, read one slice after another, so that it need
/// never be in memory as a whole.
class ArraySource {
  public:
    virtual ~ArraySource() = default;

    const ArrayInfo& info() const { return mInfo; }

    /// Puts the array elsewhere: `spacing` is that of voxels along the array's x, y and z, world
    /// units, and keeps the directions of its axes; `origin` is the centre of voxel (0, 0, 0).
    /// Throws Error(ErrorKind::Usage) for spacings that are not above 0.
    void place(const std::optional<openvdb::Vec3d>& spacing,
               const std::optional<openvdb::Vec3d>& origin);

    /// Brings the array to another space of scans, "LPS", "RAS" or "LAS". Throws
    /// Error(ErrorKind::Usage) if it does not say that it is in one.
    void turnTo(const std::string& space);

    /// Reads the next slices, as many as `values` has room for, a whole number. Values as floats:
    /// whole numbers beyond 2²⁴ and doubles are rounded. Throws Error(ErrorKind::Input) if the file
    /// ends too early or is damaged.
    virtual void readSlices(std::span<float> values) = 0;

  protected:
    explicit ArraySource(ArrayInfo info) : mInfo(std::move(info)) {}

  private:
    ArrayInfo mInfo;
};

/// How an array is read.
struct ArrayReadOptions {
    /// Of images with several channels: the name of one ("R", "A", ...), its number, counted from
    /// 0, or "luminance". If empty, the channels of colours have to be equal, and alpha full.
    std::string channel;
    /// Of DICOM files of several series: the UID of one, or its number in the list that the error
    /// shows, counted from 0.
    std::string series;
};

/// True if a file is named like one that holds an array: .npy, .nrrd, .nhdr, .mha or .mhd.
bool isArrayFile(const std::filesystem::path& path);

/// True if openArray takes what is named so: an array file, an image, a pattern of images, a folder
/// that is there, or a DICOM file.
bool isArrayInput(const std::filesystem::path& path);

/// Opens a file:
/// - NumPy's .npy, versions 1 to 3, any byte order, [x][y][z] in C or Fortran order, bool, whole
///   numbers, half, float or double;
/// - NRRD, .nrrd with the values inside and .nhdr with them beside; raw, gzip or text; spacings, or
///   space directions and origin;
/// - MetaImage, .mha and .mhd; raw or compressed; spacing, offset and orientation;
/// - an image, .tif, .png, .exr or another that OpenImageIO reads: each page is a slice;
/// - a DICOM file, by its extension .dcm or its content: each frame is a slice.
/// Values beside a header are looked for where the header is. One number to a voxel.
///
/// Or opens several:
/// - a folder of images of one kind, in the order of the numbers in their names;
/// - images named by a pattern, "slice.####.tif" or "slice%04d.png";
/// - a folder of DICOM files, in the order of their places.
/// Of images x runs along rows, y down columns and z from slice to slice.
///
/// Throws Error(ErrorKind::Input) if it is missing, malformed, or holds something else, if slices
/// differ in size or type, or are missing; Error(ErrorKind::Usage) for a channel or a series that
/// is none.
std::unique_ptr<ArraySource> openArray(const std::filesystem::path& path,
                                       const ArrayReadOptions& options = {});

}  // namespace bandvox
