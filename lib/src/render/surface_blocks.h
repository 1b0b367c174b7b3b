#pragma once

#include <bandvox/render/camera.h>

#include <openvdb/openvdb.h>

#include <functional>

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

    /// Calls `visit(t0, t1)` for each block on the way of origin + t·direction, t ≥ 0, in order;
    /// stops when it returns true. `direction` may have any length but 0.
    void walk(const Ray& ray, const std::function<bool(double, double)>& visit) const;

  private:
    void mark(const openvdb::CoordBBox& voxels);

    openvdb::MaskTree mBlocks;  // one voxel for each block
    openvdb::BBoxd mBox;        // of the blocks
    double mMaximum;
};

}  // namespace bandvox
