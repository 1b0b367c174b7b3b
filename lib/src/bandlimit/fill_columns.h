#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/density_column.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/spread_bricks.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/worker_pool.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace bandvox {

/// Columns of tiles, in the order of the layout's (y, z): y·count.z + z.
struct FilledColumns {
    std::vector<ColumnBlocks> blocks;
    std::vector<ColumnStatistics> statistics;
    double brickSeconds = 0;  ///< spent on what several columns share

    /// That of all columns together.
    ColumnStatistics total() const;
};

/// Fills columns of tiles, in parallel: all of them, or those that are true in `wanted`, which has
/// as many as the layout has columns. The others stay empty. `stage` is what progress calls it.
/// Throws Error(ErrorKind::Interrupted).
FilledColumns fillColumns(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter, const char* stage,
                          Progress& progress, const std::vector<bool>& wanted = {});

/// Bytes that the blocks of a column take.
std::size_t memoryOf(const ColumnBlocks& blocks);

/// Fills columns of tiles in their order, as many at a time as there is memory for. What the
/// memory is does not change what comes out, only in how many parts.
class ColumnFiller {
  public:
    static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

    /// Sorts the elements by columns. What is given has to stay.
    ColumnFiller(const BoundarySource& source, const TilePlan& plan, const TileLayout& layout,
                 const TileFilter& filter, std::vector<bool> wanted = {});

    /// Steps by which filling all columns advances progress.
    static std::int64_t steps(const BoundarySource& source, const TilePlan& plan,
                              const TileLayout& layout);

    /// Fills the columns after those that were filled before: as many as take up to `memory` bytes,
    /// with what is kept for those that follow, but one at least. Throws
    /// Error(ErrorKind::Interrupted).
    FilledColumns fillNext(double memory, Progress& progress);

    bool isDone() const { return mNext == mCount; }

    /// The largest that a call has needed for one column so far, bytes.
    double leastMemory() const;

  private:
    void prepareBricks(double memory, FilledColumns& columns, Progress& progress);

    const BoundarySource& mSource;
    const TilePlan& mPlan;
    const TileLayout& mLayout;
    const TileFilter& mFilter;
    std::vector<bool> mWanted;
    std::int64_t mCount;
    std::int64_t mNext = 0;
    // What the source gives to tiles: bricks for all columns of some rows, or bins.
    std::optional<SpreadBricks> mBricks;
    std::optional<ElementBins> mBins;
    int mRowsEnd = 0;         // of the rows that there are bricks for
    double mRowOfBricks = 0;  // largest seen, bytes
    double mLargestColumn;    // the same, of its blocks
    WorkerPool<DensityColumn> mPool;
};

}  // namespace bandvox
