#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/density_column.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>

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

}  // namespace bandvox
