#pragma once

#include "reconstruct/brick_sums.h"
#include "reconstruct/interpolation_design.h"

#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/reconstruct/reconstruction.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace bandvox {

/// Memory that building a brick needs for a while; one per thread.
struct BrickScratch {
    std::vector<float> lattice;
    std::vector<float> filtered;
};

/// The coefficients c = a * f of one brick of the lattice, and the sums f~(x) = Σ c_l ψ(l - x)
/// over them. Its sums depend on the lattice and the brick's place alone.
class CoefficientBrick {
  public:
    /// Voxels along a side; brick b holds the places [b·kSide, (b + 1)·kSide).
    static constexpr int kSide = 32;

    /// `mostlyRead`, if given, leaves out what is farther than a voxel or two from nodes of such
    /// densities.
    CoefficientBrick(const openvdb::FloatGrid& grid, const openvdb::Coord& brick,
                     const InterpolationDesign& design,
                     const std::optional<DensityBand>& mostlyRead, BrickScratch& scratch);

    /// False for places that were left out; a place is given relative to the brick's first voxel,
    /// within [0, kSide).
    bool holds(const openvdb::Vec3d& local) const {
        return local[0] >= mBegin[0] && local[0] < mEnd[0] && local[1] >= mBegin[1] &&
               local[1] < mEnd[1] && local[2] >= mBegin[2] && local[2] < mEnd[2];
    }

    /// The density at a place that it holds.
    double value(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const;
    /// The density and its gradient there.
    DensityAt evaluate(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const;

    /// The density, its gradient and its Hessian there.
    DensityExpansion expand(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const;

    /// Bytes that a brick takes at most.
    static std::size_t bytes(const SpreadingKernel& kernel);

  private:
    BrickNodes nodes() const { return {mCoefficients.get(), mRows, mPitch}; }

    openvdb::Vec3d mBegin, mEnd;             // of the places that it holds, whole voxels
    int mRows = 0;                           // along y
    int mPitch = 0;                          // along z, with room for the kernel's padding
    float mConstant = 0;                     // of a brick without coefficients
    std::unique_ptr<float[]> mCoefficients;  // [x][mRows][mPitch]; none if all are the same
};

}  // namespace bandvox
