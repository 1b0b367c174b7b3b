#pragma once

#include "render/block_walk.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/camera.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bandvox {

/// Where along a line of sight the surface {density = iso} can be: the blocks of 4³ voxels near
/// lattice values that are high enough. All lengths in voxels, index coordinates.
class SurfaceBlocks {
  public:
    /// Marks the blocks within a voxel of a value ≥ `threshold`, which must be above the grid's
    /// background. Memory and time are set by the leaves and by the surface of what tiles fill.
    /// Throws Error(ErrorKind::Memory) before allocating if what is around large tiles would not
    /// fit, Error(ErrorKind::Interrupted) if the caller wants to stop.
    SurfaceBlocks(const openvdb::FloatGrid& grid, double threshold,
                  const Progress& progress = silentProgress());

    bool empty() const { return mBox.empty(); }

    /// The largest value of the lattice.
    double maximum() const { return mMaximum; }

    /// False if a value of the lattice is not finite, or so large that sums of them are not.
    bool finite() const { return mFinite; }

    /// The t ≥ 0 where a ray comes into the box of all blocks; nothing if it passes by.
    std::optional<double> entry(const Ray& ray) const;

    /// False if no block is in a box; true if one is, or if the box is large and near them.
    bool touches(const openvdb::BBoxd& box) const;

    /// Calls `visit(t0, t1)` for each block on the way of origin + t·direction, 0 ≤ t ≤ `end`, in
    /// order; stops when it returns true. `direction` may have any length but 0.
    template <typename Visitor>
    void walk(const Ray& ray, double end, const Visitor& visit) const;

    /// Blocks in a cube.
    struct Group {
        openvdb::Coord first;       ///< its first voxel
        int side;                   ///< blocks
        const std::uint64_t* rows;  ///< which of 8³ are there, as a leaf's mask; null if all are
    };
    /// All blocks, a group for each node of the tree; valid as long as this object. Throws
    /// Error(ErrorKind::Interrupted) if the caller wants to stop.
    std::vector<Group> groups(const Progress& progress = silentProgress()) const;

    /// Voxels along a block.
    static constexpr int kSide = 4;

  private:
    static constexpr int kLog2 = 2;
    static_assert(kSide == 1 << kLog2);

    void markLargeTiles(const std::vector<openvdb::CoordBBox>& tiles, const Progress& progress);

    openvdb::MaskTree mBlocks;  // one voxel for each block
    openvdb::BBoxd mBox;        // of the blocks
    double mMaximum;
    bool mFinite = true;
};

template <typename Visitor>
void SurfaceBlocks::walk(const Ray& ray, double end, const Visitor& visit) const {
    walkBlocks(mBlocks, mBox, inBlocks(ray, kSide, end),
               [&](double t0, double t1, bool /*value*/) { return visit(t0, t1); });
}

}  // namespace bandvox
