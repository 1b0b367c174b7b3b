#pragma once

#include <bandvox/grid/write_array.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace bandvox {

std::size_t bytesOf(VoxelType type);

/// The voxels of a grid's box as slices of bytes, one after another.
class VoxelSlices {
  public:
    /// `axes`: of the order of the bytes, the fastest first. Throws as writeArray.
    VoxelSlices(const openvdb::FloatGrid& grid, const VoxelsToWrite& voxels,
                std::array<int, 3> axes);

    const openvdb::CoordBBox& box() const { return mResult.box; }
    openvdb::Coord size() const { return mResult.box.dim(); }
    int slices() const { return size()[mAxes[2]]; }
    std::size_t bytesPerSlice() const;

    /// How many of the next slices lie in one row of leaves, so that they are read together; 0 at
    /// the end.
    int together() const;

    /// The next slices, as many as are together, in the machine's byte order.
    const std::vector<char>& next();

    /// What has been read so far.
    const WrittenVoxels& result() const { return mResult; }

  private:
    void fill(int slices);
    void encode(int slices);

    const openvdb::FloatGrid& mGrid;
    VoxelsToWrite mVoxels;
    std::array<int, 3> mAxes;
    WrittenVoxels mResult;
    int mNext = 0;  // slice
    std::vector<float> mValues;
    std::vector<char> mBytes;
};

}  // namespace bandvox
