#include "bandlimit/density_column.h"
#include "bandlimit/density_steps.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/worker_pool.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace bandvox {

namespace {

// Bytes that the grid and the work on it will take, from the surface's area. The factors are
// measured on meshes between 128³ and 1024³; they are meant to be a little high.
double estimateMemory(const BoundarySource& source, const TilePlan& plan, const TileLayout& layout,
                      const TileFilter& filter) {
    const double area = source.area() / (layout.voxelSize * layout.voxelSize);
    const double thickness = plan.halo + DensityLeaf::DIM;  // of the leaves along the surface
    const double leaves = area * thickness / DensityLeaf::SIZE;
    const double perThread = 4.0 * static_cast<double>(filter.bufferSize()) +
                             4.0 * std::pow(plan.interior, 3) +
                             sizeof(SurfaceSample) * 8.0 * plan.side * plan.side;
    return memoryOfGrid(leaves, layout) + 12.0 * static_cast<double>(source.elementCount()) +
           threadCount() * perThread;
}

// Fills all columns of tiles, in parallel.
std::vector<ColumnBlocks> fillColumns(const BoundarySource& source, const TilePlan& plan,
                                      const TileLayout& layout, const TileFilter& filter,
                                      ColumnStatistics& statistics, Progress& progress) {
    const ElementBins bins(source, layout, plan.halo);
    const std::int64_t count = static_cast<std::int64_t>(layout.count.y()) * layout.count.z();
    std::vector<ColumnBlocks> columns(count);
    std::vector<ColumnStatistics> perColumn(count);
    WorkerPool<DensityColumn> pool(
        [&] { return std::make_unique<DensityColumn>(source, plan, layout, filter); });
    const ProgressStage stage(progress, "band-limiting", count);
    parallelFor(count, [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const int y = static_cast<int>(i / layout.count.z());
        const int z = static_cast<int>(i % layout.count.z());
        const std::span<const std::uint32_t> elements = bins.column(y, z);
        if (!elements.empty()) {
            std::unique_ptr<DensityColumn> worker = pool.take();
            columns[i] = worker->fill(y, z, elements, perColumn[i], progress);
            pool.giveBack(std::move(worker));
        }
        progress.advance();
    });
    for (const ColumnStatistics& column : perColumn) statistics.add(column);
    return columns;
}

// Shells that overlap add up. Returns true if that happened, and says so.
bool findOverlap(const ColumnStatistics& statistics, const ExponentialFilter& filter,
                 double tolerance, std::vector<std::string>& warnings) {
    // A filter that never rings goes beyond 1 only where shells overlap, in however thin a part.
    const double exact = 10 * (tolerance + filter.atNyquist());
    const bool isAboveOne = filter.order <= 2 && statistics.maximum > 1 + exact;
    if (statistics.highestWinding <= 1 && statistics.lowestWinding >= 0 && !isAboveOne) {
        return false;
    }
    warnings.push_back("parts of the surface overlap or are inside out (density from " +
                       inShort(statistics.minimum) + " to " + inShort(statistics.maximum) +
                       "); it was limited to [0, 1], and its integral is not the volume");
    return true;
}

}  // namespace

DensityResult surfaceToDensity(const BoundarySource& source, const DensityOptions& options,
                               Progress& progress) {
    // Decide how the work is cut up, and whether it fits.
    requireValid(options);
    const double voxelSize = chooseVoxelSize(source.bounds(), options);
    const TilePlan plan = makeTilePlan(options);
    const TileLayout layout = layOutTiles(source.bounds(), voxelSize, plan);
    const TileFilter filter(plan);
    requireMemory(estimateMemory(source, plan, layout, filter),
                  ("a grid of voxels of " + inShort(voxelSize) + " world units").c_str());

    // Filter the tiles, and check what was measured on the way.
    DensityResult result;
    warnOfFilter(options.filter, options.tolerance, result.warnings);
    ColumnStatistics statistics;
    std::vector<ColumnBlocks> columns =
        fillColumns(source, plan, layout, filter, statistics, progress);
    // What the lattice cannot hold keeps ringing away from the surface; it was warned of.
    const double unheld = std::max(0.0, options.filter.atNyquist() - options.tolerance);
    if (statistics.closureError > options.tolerance + unheld) {
        throw Error(ErrorKind::Result,
                    source.name() + ": the density is off by " + inShort(statistics.closureError) +
                        " where it should be a whole number, more than the tolerance of " +
                        inShort(options.tolerance));
    }
    const bool clamp =
        findOverlap(statistics, options.filter, options.tolerance, result.warnings) ||
        options.clamp;

    // Join the columns to one grid.
    DensityMetadata& metadata = result.metadata;
    metadata.source = source.name();
    metadata.route = "exact";
    metadata.closureError = statistics.closureError;
    metadata.sourceVolume = source.volume();
    metadata.clamped = clamp;
    finishGrid(columns, voxelSize, options, plan, result, progress);

    result.surfaceSamples = statistics.samples;
    result.tiles = statistics.tiles;
    result.kernelWidth = plan.kernel.width();
    result.minimum = statistics.minimum;
    result.maximum = statistics.maximum;
    result.spreadSeconds = statistics.spreadSeconds;
    result.transformSeconds = statistics.transformSeconds;
    return result;
}

}  // namespace bandvox
