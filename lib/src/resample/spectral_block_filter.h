#pragma once

#include "reconstruct/interpolation_design.h"
#include "resample/block_filter.h"
#include "spectral/packed_filter.h"

namespace bandvox {

/// Filters by two transforms of a cube around each block, whatever the filter and the lattices, and
/// reads the result between its nodes where it has to, along one axis after the other if axes lie
/// on axes.
class SpectralBlockFilter final : public BlockFilter {
  public:
    /// Throws as makeBlockFilter.
    SpectralBlockFilter(const LatticeMap& map, const LatticeFilter& filter);

    double scratchBytes() const override;
    SourceCube sourceCube(const openvdb::Coord& block) const override;
    Scratch allocate() const override;
    void apply(const openvdb::Coord& block, Scratch& scratch,
               std::span<float> values) const override;

  private:
    static int chooseSide(const LatticeMap& map, int reach);
    PackedFilter transferOf(const LatticeFilter& filter) const;
    AxisTaps tapsAlong(int axis, const openvdb::Coord& block, int cubeOrigin) const;

    bool mIsAligned;   // target voxels are source voxels: nothing is to be read between them
    bool mIsDiagonal;  // between them it is read along one axis after the other
    InterpolationDesign mDesign;
    const RealFft3& mFft;
    PackedFilter mTransfer;
};

}  // namespace bandvox
