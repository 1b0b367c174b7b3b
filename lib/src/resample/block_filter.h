#pragma once

#include "resample/axis_sums.h"
#include "resample/lattice_map.h"
#include "spectral/fft.h"

#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace bandvox {

/// What of a grid's frequencies is kept on the way to another lattice.
struct LatticeFilter {
    std::optional<ExponentialFilter> kept;    ///< on the target; nothing: all
    std::optional<ExponentialFilter> before;  ///< what is in the source, if that is known
    double tolerance;                         ///< relative to the source's amplitude

    /// By how much frequencies that the source has too little of are raised at most.
    static constexpr double kHighestGain = 4;

    /// ĝ(k); k in cycles per source voxel.
    double operator()(const LatticeMap& map, const openvdb::Vec3d& k) const;

    /// How far, in source voxels, the filter reaches.
    int reach(const LatticeMap& map) const;
};

/// Voxels of a source in memory: (x, y, z) of the box lies at (x·yCount + y)·zStride + z.
struct SourceCube {
    openvdb::CoordBBox box;
    int yCount, zStride;
};

/// Makes cubes of a target lattice out of the voxels under them and around.
///
/// Immutable once built, and shared by all threads; each thread has scratch memory of its own.
class BlockFilter {
  public:
    struct Scratch {
        FftBuffer cube;
        AxisSumScratch sums;
    };

    virtual ~BlockFilter() = default;

    /// Target voxels along a block's side, a multiple of 8.
    int blockSide() const { return mBlockSide; }
    /// How far from a target voxel's place the source matters, source voxels.
    int reach() const { return mReach; }
    /// Bytes that a thread needs.
    virtual double scratchBytes() const = 0;

    /// The voxels of the source that matter to a block.
    openvdb::CoordBBox sourceBox(const openvdb::Coord& block) const;
    /// The voxels that are handed to `apply`, and how.
    virtual SourceCube sourceCube(const openvdb::Coord& block) const = 0;

    virtual Scratch allocate() const = 0;

    /// Turns what lies in the scratch's cube into the block's values, z fastest.
    virtual void apply(const openvdb::Coord& block, Scratch& scratch,
                       std::span<float> values) const = 0;

  protected:
    BlockFilter(const LatticeMap& map, int reach) : mMap(map), mReach(reach) {}

    const LatticeMap mMap;
    int mReach;
    int mBlockSide = 0;
};

/// The cheapest one: three passes along the axes if axes lie on axes and the filters are Gaussians,
/// otherwise transforms. Throws Error(ErrorKind::Usage) if the filter reaches too far, or if what
/// is kept cannot be read between the nodes.
std::unique_ptr<BlockFilter> makeBlockFilter(const LatticeMap& map, const LatticeFilter& filter);

}  // namespace bandvox
