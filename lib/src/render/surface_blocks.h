#pragma once

#include <bandvox/render/camera.h>

#include <openvdb/openvdb.h>

#include <functional>
#include <optional>

namespace bandvox {

/// Where along a line of sight the surface {density = iso} can be: the blocks of 8³ voxels near
/// lattice values that are high enough. All lengths in voxels, index coordinates.
class SurfaceBlocks {
  public:
    /// Marks the blocks within two voxels of a value ≥ `threshold`, which must be above the
    /// grid's background.
    SurfaceBlocks(const openvdb::FloatGrid& grid, double threshold);

    bool empty() const { return mBlocks.empty(); }

    /// The largest value of the lattice.
    double maximum() const { return mMaximum; }

    /// False if a value of the lattice is not finite, or so large that sums of them are not.
    bool finite() const { return mFinite; }

    /// The t ≥ 0 where a ray comes into the box of all blocks; nothing if it passes by.
    std::optional<double> entry(const Ray& ray) const;

    /// Calls `visit(t0, t1)` for each block on the way of origin + t·direction, t ≥ 0, in order;
    /// stops when it returns true. `direction` may have any length but 0.
    void walk(const Ray& ray, const std::function<bool(double, double)>& visit) const;

  private:
    void mark(const openvdb::CoordBBox& voxels);

    openvdb::MaskTree mBlocks;  // one voxel for each block
    openvdb::BBoxd mBox;        // of the blocks
    double mMaximum;
    bool mFinite = true;
};

}  // namespace bandvox
