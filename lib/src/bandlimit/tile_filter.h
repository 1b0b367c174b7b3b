#pragma once

#include "bandlimit/spread_samples.h"
#include "bandlimit/tile_plan.h"
#include "spectral/fft.h"
#include "spectral/packed_filter.h"

#include <array>
#include <span>
#include <vector>

namespace bandvox {

/// Filters one tile at a time: weighted samples in, and out either h * (Σ_j w_j δ(x - y_j)), or
/// what that is the derivative of: differences along x of the density, if they weigh -n_x dA.
///
/// Immutable once built, and shared by all threads; each thread has a buffer of its own.
class TileFilter {
  public:
    enum class Output { Differences, Values };

    explicit TileFilter(const TilePlan& plan, Output output = Output::Differences);

    /// A buffer for one thread's work, all zero.
    FftBuffer allocate() const { return mFft.allocate(); }
    std::size_t bufferSize() const { return mFft.bufferSize(); }

    /// Where, in voxels from the first voxel of a tile's interior, the samples that matter to it
    /// begin. They extend over `plan.side` voxels along each axis.
    openvdb::Vec3d regionOffset() const;

    /// The lattice of a buffer. A place of the region lies at the node that is `shift()` further
    /// along each axis; what is spread there reaches nodes up to `reachBehind()` behind the region
    /// along x and y, and z up to what the kernel is padded to.
    SpreadLattice lattice(float* buffer) const { return {buffer, mFft.yCount(), mFft.zStride()}; }
    int shift() const { return mShift; }
    int reachBehind() const { return mMargin; }

    /// Spreads the samples (positions from the region's beginning) onto the buffer, which must
    /// be all zero.
    void spread(std::span<const SurfaceSample> samples, float* buffer) const;

    /// The same for two weights, each onto a buffer of its own. `scratch` has twice a buffer's
    /// size; it must be all zero, and is again.
    void spread(std::span<const PairedSample> samples, float* scratch,
                const std::array<float*, 2>& buffers) const;

    /// Turns what was spread into the values, or into f~(x, y, z) - f~(x - 1, y, z). Elsewhere than
    /// in the interior, what is left in the buffer has no meaning.
    void apply(float* buffer) const;

    /// What comes out, along z at (x, y, 0) of the interior.
    const float* row(const float* buffer, int x, int y) const {
        return buffer +
               (static_cast<std::size_t>(x + mFirst + 1) * mFft.yCount() + y + mFirst) *
                   mFft.zStride() +
               mFirst;
    }

  private:
    template <typename Sample>
    openvdb::CoordBBox nodesUnder(std::span<const Sample> samples) const;
    void moveNodes(const openvdb::CoordBBox& nodes, float* part, float* buffer) const;
    void movePairs(const openvdb::CoordBBox& nodes, float* part,
                   const std::array<float*, 2>& buffers) const;
    void fold(float* buffer) const;

    const TilePlan& mPlan;
    int mShift;   // nodes before the region, for the kernel's left half
    int mMargin;  // nodes behind it, for the shift and its right half
    int mFirst;   // where the interior begins in y and z
    const RealFft3& mFft;
    PackedFilter mTransfer;
};

}  // namespace bandvox
