#include "bandlimit/density_steps.h"
#include "bandlimit/exact_route.h"
#include "bandlimit/fill_columns.h"
#include "bandlimit/find_overlap.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bandvox {

namespace {

// The columns of a part of the grid.
std::vector<bool> columnsOf(const Shard& shard, const TileLayout& layout) {
    if (shard.isWhole()) return {};
    const std::int64_t count = static_cast<std::int64_t>(layout.count.y()) * layout.count.z();
    std::vector<bool> wanted(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
        wanted[static_cast<std::size_t>(i)] = shard.holds(i);
    }
    return wanted;
}

// Fills columns, so that they are whole numbers away from the surface to within what is allowed.
FilledColumns fillToTolerance(ExactRoute& route, const TileFilter& filter, int& refinements,
                              Progress& progress) {
    const std::vector<bool> wanted = columnsOf(route.options.shard, route.layout);
    for (refinements = 0;; ++refinements) {
        FilledColumns columns = fillColumns(route.source, route.plan, route.layout, filter,
                                            "band-limiting", progress, wanted);
        const double error = columns.total().closureError;
        if (error <= route.allowedError()) return columns;
        route.refine(refinements, error);
    }
}

}  // namespace

DensityResult surfaceToDensity(const BoundarySource& source, const DensityOptions& options,
                               Progress& progress) {
    // Decide how the work is cut up, and whether it fits.
    ExactRoute route(source, options);
    const TileFilter filter(route.plan);
    const ExactRouteMemory memory(route, filter);
    requireMemory(memoryOfGrid(memory.leaves) + memory.columns + memory.elements + memory.bricks +
                      threadCount() * memory.thread,
                  route.wanted().c_str());

    // Filter the tiles, and check what was measured on the way.
    DensityResult result;
    warnOfFilter(options.filter, options.tolerance, result.warnings);
    FilledColumns columns = fillToTolerance(route, filter, result.refinements, progress);
    const ColumnStatistics statistics = columns.total();
    result.overlaps = !options.sumOverlaps &&
                      findOverlap(source, options, route.layout, columns.statistics, progress);

    // Join the columns to one grid.
    stateMeasured(route, statistics, result);
    finishGrid(columns.blocks, route.layout, options, route.plan, result, progress);
    stateGrid(route, statistics, result);
    return result;
}

}  // namespace bandvox
