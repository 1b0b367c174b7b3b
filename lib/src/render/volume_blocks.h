#pragma once

#include "render/block_walk.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/camera.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <optional>
#include <vector>

namespace bandvox {

/// Where along a line of sight a density is more than nothing, and how much at most: for each block
/// of 8³ voxels. All lengths in voxels, index coordinates.
class VolumeBlocks {
  public:
    static constexpr int kLog2 = 3;
    static constexpr int kSide = 1 << kLog2;  ///< of a block, voxels
    /// Of the largest cube of blocks that walk() visits at once, voxels.
    static constexpr int kVisited = kSide * static_cast<int>(openvdb::FloatTree::LeafNodeType::DIM);

    /// `filter`: what the lattice was filtered with; without, it is read by averages. `least`: a
    /// density that stops no light to speak of; of densities below it, those are left out that are
    /// nothing beside the highest, too. The background of `grid` is 0. Memory and time are set by
    /// the leaves and by the surface of what tiles of one density fill. Throws
    /// Error(ErrorKind::Memory) before allocating if what is around large tiles would not fit,
    /// Error(ErrorKind::Interrupted) if the caller wants to stop.
    VolumeBlocks(const openvdb::FloatGrid& grid, const std::optional<ExponentialFilter>& filter,
                 double least, const Progress& progress = silentProgress());

    bool empty() const { return mBox.empty(); }
    /// False if a value of the lattice is not finite, or so large that sums of them are not.
    bool finite() const { return mFinite; }

    /// Calls `visit(t0, t1, most)` for each block on the way of origin + t·direction,
    /// 0 ≤ t ≤ `end`, in order; stops when it returns true.
    template <typename Visitor>
    void walk(const Ray& ray, double end, const Visitor& visit) const {
        walkBlocks(mBlocks, mBox, inBlocks(ray, kSide, end),
                   [&](double t0, double t1, float most) { return visit(t0, t1, double(most)); });
    }

  private:
    // A tile of the lattice, and how much the density in and beside it is at most.
    struct Tile {
        openvdb::CoordBBox blocks;
        float most;
    };
    void raiseAround(const std::vector<Tile>& tiles, const Progress& progress);
    void raise(const openvdb::Coord& block, float most);

    openvdb::FloatTree mBlocks;  // one voxel for each block
    openvdb::BBoxd mBox;
    bool mFinite = true;
};

}  // namespace bandvox
