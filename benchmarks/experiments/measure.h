#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/source/boundary_source.h>

#include <openvdb/openvdb.h>

#include <functional>
#include <memory>
#include <optional>

namespace bandvox::experiments {

/// The error allowed to everything but what is measured.
inline constexpr double kTolerance = 1e-5;
/// The same of reading a density between voxels.
inline constexpr double kReadingTolerance = 1e-4;

/// The density of a solid by the exact route; `voxelSize` in world units.
DensityResult exactDensity(const BoundarySource& solid, const ExponentialFilter& filter,
                           double voxelSize);

/// By how much a density differs from the true one.
struct DensityError {
    double largest = 0;  ///< over all voxels
    double rms = 0;      ///< root of the sum of squares over all voxels by the number of those of
                         ///< the edge, whose true density is between 5 and 95 %
};
DensityError compare(const openvdb::FloatGrid& density, const openvdb::FloatGrid& truth);

/// A reader of a density of voxels, for one thread.
class DensityReader {
  public:
    DensityReader(const openvdb::FloatGrid::Ptr& grid, const ExponentialFilter& filter);

    /// Another reader of the same density, for another thread.
    DensityReader another() const { return DensityReader(mReconstruction); }

    /// Density and gradient at a place, voxels.
    DensityAt at(const openvdb::Vec3d& place) const { return mProbe->evaluate(place); }

    /// How far along the line from `start` (voxels; `direction` of length 1) the density first
    /// falls below `iso`, voxels; nothing if it does not within `farthest`.
    std::optional<double> firstBelow(double iso, const openvdb::Vec3d& start,
                                     const openvdb::Vec3d& direction, double farthest) const;

  private:
    explicit DensityReader(std::shared_ptr<Reconstruction> reconstruction)
        : mReconstruction(std::move(reconstruction)), mProbe(mReconstruction->probe()) {}

    std::shared_ptr<Reconstruction> mReconstruction;
    std::unique_ptr<DensityProbe> mProbe;
};

/// Where `function` first falls below `level` on [low, high], found to 1e-7; nothing if nowhere.
/// Steps of 1/16 are looked at; it starts at or above the level, or the answer is `low`.
std::optional<double> firstBelow(const std::function<double(double)>& function, double level,
                                 double low, double high);

/// Where a rising `function` passes `level` in [low, high], found to 1e-4.
double solveRising(const std::function<double(double)>& function, double level, double low,
                   double high);

}  // namespace bandvox::experiments
