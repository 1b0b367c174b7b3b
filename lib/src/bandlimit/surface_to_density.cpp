#include "bandlimit/density_column.h"
#include "bandlimit/density_steps.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/words.h"
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

// How far the integral may be from the volume, in tolerances, before it is worth a word.
constexpr double kVolumeMargin = 10;

// Bytes that the grid will take, from the surface's area.
double estimateGridMemory(const BoundarySource& source, double voxelSize, const TilePlan& plan) {
    const double area = source.area() / (voxelSize * voxelSize);
    const double thickness = 2 * plan.halo + DensityLeaf::DIM;  // of the leaves along the surface
    return memoryOfGrid(area * thickness / DensityLeaf::SIZE);
}

// Bytes that the work on it takes besides.
double estimateWorkMemory(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter) {
    const double perThread = 4.0 * static_cast<double>(filter.bufferSize()) +
                             4.0 * std::pow(plan.interior, 3) +
                             sizeof(SurfaceSample) * 8.0 * plan.side * plan.side;
    return memoryOfColumns(layout) + 12.0 * static_cast<double>(source.elementCount()) +
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

// What lies below the storage threshold is lost, and of an object of few voxels that is much.
void warnOfVolume(const DensityMetadata& metadata, std::vector<std::string>& warnings) {
    const double difference = std::abs(metadata.gridVolume / metadata.sourceVolume - 1);
    if (difference <= kVolumeMargin * metadata.tolerance) return;
    warnings.push_back("the integral of the density differs from the volume by " +
                       inShort(100 * difference) +
                       " %, since the object is small in voxels; use more of them, or a smaller "
                       "tolerance");
}

}  // namespace

DensityResult surfaceToDensity(const BoundarySource& source, const DensityOptions& options,
                               Progress& progress) {
    // Decide how the work is cut up, and whether it fits.
    requireValid(options);
    const double voxelSize = chooseVoxelSize(source.name(), source.bounds(), options);
    const TilePlan plan = makeTilePlan(options);
    const std::string wanted = "a grid of voxels of " + inShort(voxelSize) + " world units";
    const double gridMemory = estimateGridMemory(source, voxelSize, plan);
    requireMemory(gridMemory, wanted.c_str());
    const TileLayout layout = layOutTiles(source.bounds(), voxelSize, plan);
    const TileFilter filter(plan);
    requireMemory(gridMemory + estimateWorkMemory(source, plan, layout, filter), wanted.c_str());

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
    const bool isOverlapping =
        findOverlap(statistics, options.filter, options.tolerance, result.warnings);
    const bool clamp = isOverlapping || options.clamp;

    // Join the columns to one grid.
    DensityMetadata& metadata = result.metadata;
    metadata.source = source.name();
    metadata.route = "exact";
    metadata.closureError = statistics.closureError;
    metadata.sourceVolume = source.volume();
    metadata.clamped = clamp;
    finishGrid(columns, layout, options, plan, result, progress);
    if (!clamp) warnOfVolume(metadata, result.warnings);

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
