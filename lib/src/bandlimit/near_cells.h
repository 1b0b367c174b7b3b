#pragma once

#include <bandvox/source/boundary_source.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// Which cells of a tile's interior lie near the surface. In all others the density is a whole
/// number.
///
/// The interior is cut into cells of kCell³ voxels, from its first voxel on.
class NearCells {
  public:
    static constexpr int kCell = 4;

    /// `halo` and `interior` in voxels, as TilePlan has them.
    NearCells(int halo, int interior);

    /// Marks what is within the halo of the samples (positions in voxels; the interior's first
    /// voxel is at `interiorAt`).
    void mark(std::span<const SurfaceSample> samples, const openvdb::Vec3d& interiorAt);

    /// The same in steps: forgets all, adds the voxels that hold samples (counted from the
    /// interior's first), and in the end marks what is within the halo of them.
    void clear();
    void add(const openvdb::Coord& voxel);
    void widen();

    /// Cells along each axis of the interior.
    int count() const { return mCount; }

    bool isNear(int x, int y, int z) const {
        return mMarked[(static_cast<std::size_t>(x + mReach) * mSide + y + mReach) * mSide + z +
                       mReach] != 0;
    }

  private:
    void dilate(std::size_t stride);

    int mReach;  // cells of the halo before the interior
    int mCount;  // cells of the interior
    int mSide;   // both, and the halo behind
    std::vector<std::uint8_t> mMarked, mDilated;
};

}  // namespace bandvox
