#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/near_cells.h"
#include "bandlimit/spread_bricks.h"
#include "bandlimit/tile_filter.h"

#include <bandvox/core/progress.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace bandvox {

/// What is measured on the way.
struct ColumnStatistics {
    double closureError = 0;  ///< largest distance from a whole number where there should be one
    double minimum = 0;       ///< of the density
    double maximum = 0;
    double highestWinding = 0;  ///< whole numbers found away from the surface
    double lowestWinding = 0;
    std::int64_t tiles = 0;
    std::int64_t samples = 0;
    double spreadSeconds = 0;
    double transformSeconds = 0;

    void add(const ColumnStatistics& other);
    /// Takes note of a distance from a whole number; NaN counts as infinitely far.
    void addClosureError(double error) {
        if (error <= closureError) return;
        closureError = error > closureError ? error : std::numeric_limits<double>::infinity();
    }
};

/// Fills the tiles that differ only in x, from low x to high, with the running sum of the
/// differences that TileFilter makes. Made once per thread, used for many columns.
class DensityColumn {
  public:
    /// `bricks` may hold what the source gives to tiles; else null.
    DensityColumn(const BoundarySource& source, const TilePlan& plan, const TileLayout& layout,
                  const TileFilter& filter, const SpreadBricks* bricks);

    /// Does the column at (y, z), with the elements that may matter to it; without bricks.
    ColumnBlocks fill(int y, int z, std::span<const std::uint32_t> elements,
                      ColumnStatistics& statistics, const Progress& progress);

  private:
    using ElementLists = std::vector<std::vector<std::uint32_t>>;

    ElementLists sortByTile(std::span<const std::uint32_t> elements) const;
    bool fillTile(const openvdb::Coord& tile, const std::vector<std::uint32_t>& elements,
                  ColumnStatistics& statistics);
    SpreadBricks::Content spreadTile(const openvdb::Coord& tile,
                                     const std::vector<std::uint32_t>& elements);
    void sumTile(bool hasDifferences, ColumnStatistics& statistics);
    void snapCell(int y, int z, ColumnStatistics& statistics);
    void snapAll(ColumnStatistics& statistics);
    void storeTile(const openvdb::Coord& tileOrigin, BlockStore& store) const;

    const BoundarySource& mSource;
    const TilePlan& mPlan;
    const TileLayout& mLayout;
    const TileFilter& mFilter;
    const SpreadBricks* mBricks;
    FftBuffer mBuffer;
    std::size_t mBufferSize;
    NearCells mNear;
    std::vector<SurfaceSample> mSamples;
    std::vector<double> mSum;     // [interior][interior]: the density at the last x so far
    std::vector<float> mDensity;  // [interior]³
};

}  // namespace bandvox
