#pragma once

#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <complex>
#include <cstdint>
#include <vector>

namespace bandvox::reconstruct_test {

/// A density of period kPeriod: random amplitudes for all frequencies that the lattice holds, times
/// a filter; read by the direct sum of all of its waves, in double precision.
class RandomLattice {
  public:
    static constexpr int kPeriod = 64;

    /// Values are `mean` plus or minus 1 - `mean` at most, at the nodes.
    RandomLattice(const ExponentialFilter& filter, double mean, std::uint32_t seed);

    /// Re Σ_k c_k exp(2πi k·x / N) and its derivatives.
    DensityExpansion operator()(const openvdb::Vec3d& x) const;

    /// One period, and `halo` voxels around it.
    openvdb::FloatGrid::Ptr grid(int halo) const;

  private:
    static constexpr int kWaves = kPeriod - 1;  // along an axis: -31 to 31

    std::vector<double> nodes() const;  // [kPeriod][kPeriod][kPeriod]

    std::vector<std::complex<double>> mAmplitudes;  // [kWaves][kWaves][kWaves]
};

}  // namespace bandvox::reconstruct_test
