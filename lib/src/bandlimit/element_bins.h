#pragma once

#include "bandlimit/parallel_bins.h"
#include "bandlimit/tile_plan.h"

#include <bandvox/source/boundary_source.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace bandvox {

/// Which elements of a surface may matter to each column of tiles (tiles that differ only in x).
class ElementBins {
  public:
    ElementBins(const BoundarySource& source, const TileLayout& layout, int halo);

    /// The same of so many elements, of which `boundsOf` gives a box each, world units.
    ElementBins(std::size_t elementCount,
                const std::function<openvdb::BBoxd(std::size_t)>& boundsOf,
                const TileLayout& layout, int halo);

    /// Elements for the column of tiles at (y, z), in rising order.
    std::span<const std::uint32_t> column(int y, int z) const;

    /// What the bins hold, bytes.
    std::size_t memory() const { return mBins.memory(); }

  private:
    int mZCount;
    Bins mBins;  // one for each column
};

/// The tiles along `axis` whose interior, widened by the halo and a voxel, touches an interval.
struct TileRange {
    int first, last;  ///< both included
};
TileRange tilesTouching(const TileLayout& layout, int halo, int axis, double low, double high);

}  // namespace bandvox
