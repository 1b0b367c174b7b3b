#include "bandlimit/find_overlap.h"

#include "bandlimit/element_bins.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace bandvox {

namespace {

// What the second look is made with, and how far beyond [0, 1] its densities are an overlap's.
constexpr ExponentialFilter kNeverRings{2, 0.16};
constexpr double kTolerance = 1e-3;
constexpr double kMargin = 10;

// Beyond the ringing of a flat face by so much, it is worth a second look.
constexpr double kBeyondRinging = 1.05;

bool isBeyond(const ColumnStatistics& column, double limit) {
    return column.maximum > 1 + limit || column.minimum < -limit;
}

// The columns of `layout` that share voxels, along one axis, with a column of another.
TileRange columnsOver(const TileLayout& layout, int axis, const TileLayout& other, int column) {
    const int low = other.origin[axis] + column * other.interior;
    return tilesTouching(layout, 0, axis, low, low + other.interior - 1);
}

// Filters once more what is beyond the limit.
bool isBeyondWithoutRinging(const BoundarySource& source, const TileLayout& layout,
                            const std::vector<ColumnStatistics>& statistics, double limit,
                            double memory, Progress& progress) {
    DensityOptions options;
    options.filter = kNeverRings;
    options.tolerance = kTolerance;
    const TilePlan plan = makeTilePlan(options);
    const TileLayout again = layOutTiles(source.bounds(), layout.voxelSize, plan);
    std::vector<bool> wanted(static_cast<std::size_t>(again.count.y()) * again.count.z());
    for (int y = 0; y < layout.count.y(); ++y) {
        for (int z = 0; z < layout.count.z(); ++z) {
            const std::size_t column = static_cast<std::size_t>(y) * layout.count.z() + z;
            if (!isBeyond(statistics[column], limit)) continue;
            const TileRange alongY = columnsOver(again, 1, layout, y);
            const TileRange alongZ = columnsOver(again, 2, layout, z);
            for (int i = alongY.first; i <= alongY.last; ++i) {
                for (int j = alongZ.first; j <= alongZ.last; ++j) {
                    wanted[static_cast<std::size_t>(i) * again.count.z() + j] = true;
                }
            }
        }
    }
    const TileFilter filter(plan);
    const ProgressStage stage(progress, "looking for overlaps",
                              ColumnFiller::steps(source, plan, again));
    ColumnFiller filler(source, plan, again, filter, std::move(wanted));
    ColumnStatistics total;
    while (!filler.isDone()) total.add(filler.fillNext(memory, progress).total());
    return isBeyond(total, kMargin * kTolerance);
}

}  // namespace

bool findOverlap(const BoundarySource& source, const DensityOptions& options,
                 const TileLayout& layout, const std::vector<ColumnStatistics>& statistics,
                 Progress& progress, double memory) {
    ColumnStatistics total;
    for (const ColumnStatistics& column : statistics) total.add(column);
    if (total.highestWinding > 1 || total.lowestWinding < 0) return true;
    const double exact = kMargin * (options.tolerance + options.filter.atNyquist());
    if (options.filter.order <= 2) return isBeyond(total, exact);
    const double limit = std::max(exact, kBeyondRinging * filterOvershoot(options.filter));
    return isBeyond(total, limit) &&
           isBeyondWithoutRinging(source, layout, statistics, limit, memory, progress);
}

}  // namespace bandvox
