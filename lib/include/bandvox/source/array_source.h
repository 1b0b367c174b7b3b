#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>
#include <openvdb/math/Mat4.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace bandvox {

/// What a file says of the array in it.
struct ArrayInfo {
    std::string name;           ///< of the file
    openvdb::Coord size;        ///< along x, y and z; each at least 1
    std::array<int, 3> axes;    ///< the axes in the order of the file, the fastest first
    std::string valueType;      ///< "uint16", "float32", ...
    openvdb::Mat4d toWorld;     ///< from a voxel's index to its centre, acting on rows; world units
    bool hasTransform = false;  ///< the file says where its voxels lie
    std::string space;          ///< the axes of the world in the file's words, as
                                ///< "left-posterior-superior"; empty if it does not say

    std::int64_t valuesPerSlice() const { return std::int64_t(size[axes[0]]) * size[axes[1]]; }
    int slices() const { return size[axes[2]]; }
};

/// A three-dimensional array of numbers in a file, read one slice after another, so that it need
/// never be in memory as a whole.
class ArraySource {
  public:
    virtual ~ArraySource() = default;

    const ArrayInfo& info() const { return mInfo; }

    /// Reads the next slices, as many as `values` has room for, a whole number. Values as floats:
    /// whole numbers beyond 2²⁴ and doubles are rounded. Throws Error(ErrorKind::Input) if the file
    /// ends too early or is damaged.
    virtual void readSlices(std::span<float> values) = 0;

  protected:
    explicit ArraySource(ArrayInfo info) : mInfo(std::move(info)) {}

  private:
    ArrayInfo mInfo;
};

/// True if a file is named like one that openArray takes: .npy, .nrrd, .nhdr, .mha or .mhd.
bool isArrayFile(const std::filesystem::path& path);

/// Opens a file:
/// - NumPy's .npy, versions 1 to 3, any byte order, [x][y][z] in C or Fortran order, bool, whole
///   numbers, half, float or double;
/// - NRRD, .nrrd with the values inside and .nhdr with them beside; raw, gzip or text; spacings, or
///   space directions and origin;
/// - MetaImage, .mha and .mhd; raw or compressed; spacing, offset and orientation.
/// Values beside a header are looked for where the header is. One number to a voxel.
///
/// Throws Error(ErrorKind::Input) if the file is missing, malformed, or holds something else.
std::unique_ptr<ArraySource> openArray(const std::filesystem::path& path);

}  // namespace bandvox
