#pragma once

#include "render/surface_blocks.h"

#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/render/camera.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>

namespace bandvox {

/// Where a line of sight enters the solid.
struct RayHit {
    double t = 0;                      ///< along the ray, in lengths of its direction
    openvdb::Vec3d gradient{0, 0, 0};  ///< of the density, per voxel, along the index axes
};

/// How far, in voxels, from a place of some density the surface {density = iso} is at least. It
/// sets the steps of a march.
class ClearDistance {
  public:
    /// What a density may be off by if nothing is said: the tolerance of a lattice, cut off where
    /// it is not active, and that of the reconstruction.
    static constexpr double kDensityError = 1e-3;

    /// For densities that change by `steepest` per voxel at most.
    static ClearDistance ofSlope(double iso, double background, double steepest,
                                 double densityError = kDensityError);

    /// For solids under a Gaussian filter: no solid comes nearer than a half-space of the same
    /// density does, because Φ⁻¹(f~) changes by 1/σ per voxel at most, Φ being the normal
    /// distribution. D. Bakry, M. Ledoux: "Lévy-Gromov's isoperimetric inequality for an infinite
    /// dimensional diffusion generator" (1996).
    static ClearDistance ofGaussian(double iso, double cutoff, double densityError = kDensityError);

    /// `above` is the density minus iso, not positive; inside the solid, where the other side is
    /// the nearer the lower the density is, it is iso minus the density.
    double operator()(double above) const {
        const double place = std::clamp(-above * mScale, 0.0, double(kSteps));
        return mVoxels[static_cast<std::size_t>(place)];
    }

    /// How far above iso a density is, not positive, beyond which the surface is farther than this.
    double aboveWithin(double voxels) const;

  private:
    ClearDistance(double depth, double densityError, const std::function<double(double)>& distance);

    static constexpr int kSteps = 256;
    double mScale;                            // steps per density
    std::array<float, kSteps + 1> mVoxels{};  // by density below iso, rounded down
};

/// The densities of the nodes that are nearest to the places at which marches ask for the density,
/// of all but a few.
DensityBand askedBand(double iso, const ClearDistance& outside, const ClearDistance& inside);

/// Finds where lines of sight enter and leave {density ≥ iso}. All in index coordinates, `t` in
/// lengths of a ray's direction.
class RayMarch {
  public:
    /// Steps are as long as `clear` allows, but never shorter than a quarter of a voxel. `lattice`,
    /// if given, holds the density at whole coordinates: then the density is asked for only where
    /// the nearest node cannot tell that the surface is farther. `inside`: what `clear` is, for
    /// places of higher density; without it steps inside are half a voxel.
    RayMarch(const SurfaceBlocks& blocks, double iso, const ClearDistance& clear,
             const openvdb::FloatGrid* lattice = nullptr,
             const std::optional<ClearDistance>& inside = std::nullopt)
        : mBlocks(blocks), mIso(iso), mClear(clear), mInside(inside), mLattice(lattice) {}

    /// The first place on a ray, 0 ≤ t ≤ `end`, where the density rises to iso: its origin if that
    /// is inside. Within 1e-5 voxels.
    std::optional<RayHit> firstHit(const Ray& ray, DensityProbe& density,
                                   double end = std::numeric_limits<double>::max()) const;

    /// The first place on a ray, t ≥ 0, where the density falls to iso: its origin if that is
    /// outside. Nothing if it stays inside up to `end`.
    std::optional<RayHit> firstExit(const Ray& ray, DensityProbe& density,
                                    double end = std::numeric_limits<double>::max()) const;

  private:
    const SurfaceBlocks& mBlocks;
    double mIso;
    ClearDistance mClear;
    std::optional<ClearDistance> mInside;
    const openvdb::FloatGrid* mLattice;
};

}  // namespace bandvox
