#pragma once

#include "reconstruct/brick_sums.h"
#include "reconstruct/interpolation_design.h"

#include <bandvox/reconstruct/reconstruction.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace bandvox {

/// Memory that building a brick needs for a while; one per thread.
struct BrickScratch {
    std::vector<float> lattice;
    std::vector<float> filtered;
};

/// The coefficients c = a * f of one brick of the lattice, and the sums f~(x) = Σ c_l ψ(l - x)
/// over them. Its content depends on the lattice and the brick's place alone.
class CoefficientBrick {
  public:
    /// Voxels along a side; brick b holds the places [b·kSide, (b + 1)·kSide).
    static constexpr int kSide = 32;

    CoefficientBrick(const openvdb::FloatGrid& grid, const openvdb::Coord& brick,
                     const InterpolationDesign& design, BrickScratch& scratch);

    /// The density at a place given relative to the brick's first voxel, within [0, kSide).
    double value(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const;
    /// The density and its gradient there.
    DensityAt evaluate(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const;

    /// The density, its gradient and its Hessian there.
    DensityExpansion expand(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const;

    /// Bytes that a brick takes at most.
    static std::size_t bytes(const SpreadingKernel& kernel);

  private:
    BrickNodes nodes() const { return {mCoefficients.get(), mNodes, mPitch}; }

    int mNodes;                              // along x and y
    int mPitch;                              // along z, with room for the kernel's padding
    float mConstant = 0;                     // of a brick without coefficients
    std::unique_ptr<float[]> mCoefficients;  // [mNodes][mNodes][mPitch]; none if all are the same
};

}  // namespace bandvox
