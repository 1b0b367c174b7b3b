#pragma once

#include "voxelize/gpu_scan.h"
#include "voxelize/voxel_lattice.h"

#include <openvdb/math/BBox.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// Throws Error(ErrorKind::Usage) if a lattice of samples has more along a side than the GPU's
/// arithmetic takes.
void requireGpuLattice(const VoxelLattice& samples);

/// A tile of columns that the GPU scans at once, counted in blocks from the lattice's first.
class GpuTile {
  public:
    GpuTile(const VoxelLattice& lattice, const openvdb::Coord& begin, const openvdb::Coord& end)
        : mLattice(&lattice), mBegin(begin), mEnd(end) {}

    const VoxelLattice& lattice() const { return *mLattice; }
    const openvdb::Coord& begin() const { return mBegin; }
    const openvdb::Coord& end() const { return mEnd; }

    int depth() const { return mEnd.x() - mBegin.x(); }                  ///< blocks along x
    int height() const { return (mEnd.y() - mBegin.y()) * kBlockSide; }  ///< rows along y
    int width() const { return (mEnd.z() - mBegin.z()) * kBlockSide; }   ///< rows along z
    std::int64_t columnCount() const {
        return static_cast<std::int64_t>(mEnd.y() - mBegin.y()) * (mEnd.z() - mBegin.z());
    }

    /// The samples of blocks [begin, end) along x, counted from the lattice's corner().
    openvdb::CoordBBox samples(int begin, int end) const;

  private:
    const VoxelLattice* mLattice;
    openvdb::Coord mBegin, mEnd;
};

/// Cuts a lattice into tiles, and along x into passes, as small as limits ask for.
class GpuTiling {
  public:
    GpuTiling(const VoxelLattice& samples, GpuMethod method, const GpuLimits& limits);

    const std::vector<GpuTile>& tiles() const { return mTiles; }
    int passDepth() const { return mPassDepth; }   ///< blocks along x that Bits takes at once
    std::int64_t steps() const { return mSteps; }  ///< readbacks, all in all
    std::int64_t bytes() const { return mBytes; }  ///< that one readback takes at most

  private:
    std::vector<GpuTile> mTiles;
    int mPassDepth;
    std::int64_t mSteps, mBytes;
};

}  // namespace bandvox
