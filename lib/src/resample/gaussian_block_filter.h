#pragma once

#include "resample/block_filter.h"

#include <array>

namespace bandvox {

/// Filters by Gaussians along one axis after the other. Between a Gaussian of the source and the
/// one that is wanted lies a Gaussian, whose variance is their difference; summed over the nodes it
/// reads between them at the same time.
class GaussianBlockFilter final : public BlockFilter {
  public:
    /// True if axes lie on axes, the filters are Gaussians, and on each axis the one between them
    /// is so wide that its images do not show.
    static bool isFor(const LatticeMap& map, const LatticeFilter& filter);

    GaussianBlockFilter(const LatticeMap& map, const LatticeFilter& filter);

    double scratchBytes() const override;
    SourceCube sourceCube(const openvdb::Coord& block) const override;
    Scratch allocate() const override;
    void apply(const openvdb::Coord& block, Scratch& scratch,
               std::span<float> values) const override;

  private:
    AxisTaps tapsAlong(int axis, const openvdb::Coord& block, int cubeOrigin) const;
    int mostNodes(int axis) const;

    std::array<double, 3> mVariance;  // source voxels²
    std::array<int, 3> mHalfWidth;    // source voxels
};

}  // namespace bandvox
