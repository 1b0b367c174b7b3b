#pragma once

#include "render/surface_blocks.h"

#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/render/camera.h>

#include <optional>

namespace bandvox {

/// Where a line of sight enters the solid.
struct RayHit {
    double t = 0;                      ///< along the ray, in lengths of its direction
    openvdb::Vec3d gradient{0, 0, 0};  ///< of the density, per voxel, along the index axes
};

/// Finds where lines of sight enter {density ≥ iso}.
class RayMarch {
  public:
    /// `steepest` is how fast the density changes at most, per voxel; > 0. It sets the steps,
    /// which are never shorter than a quarter of a voxel.
    RayMarch(const SurfaceBlocks& blocks, double iso, double steepest)
        : mBlocks(blocks), mIso(iso), mSteepest(steepest) {}

    /// The first place on a ray, in index coordinates, t ≥ 0, where the density rises to iso: its
    /// origin if that is inside. Within 1e-5 voxels.
    std::optional<RayHit> firstHit(const Ray& ray, DensityProbe& density) const;

  private:
    const SurfaceBlocks& mBlocks;
    double mIso;
    double mSteepest;
};

}  // namespace bandvox
