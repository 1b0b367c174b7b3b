#include "bandlimit/density_column.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/grid_assembly.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/worker_pool.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace bandvox {

namespace {

constexpr double kLowestTolerance = 1e-6;
constexpr double kHighestTolerance = 0.05;
constexpr int kHighestResolution = 1 << 20;
constexpr int kLargestTile = 512;

std::string inShort(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

void requireValid(const DensityOptions& options) {
    requireValid(options.filter);
    if (options.voxelSize == 0 &&
        (options.resolution < 1 || options.resolution > kHighestResolution)) {
        throw Error(ErrorKind::Usage, "the resolution is " + std::to_string(options.resolution) +
                                          "; it must be between 1 and " +
                                          std::to_string(kHighestResolution));
    }
    if (!(options.voxelSize >= 0 && std::isfinite(options.voxelSize))) {
        throw Error(ErrorKind::Usage, "the voxel size is " + inShort(options.voxelSize) +
                                          "; it must be positive, in world units");
    }
    if (!(options.tolerance >= kLowestTolerance && options.tolerance <= kHighestTolerance)) {
        throw Error(ErrorKind::Usage, "the tolerance is " + inShort(options.tolerance) +
                                          "; it must be between " + inShort(kLowestTolerance) +
                                          " and " + inShort(kHighestTolerance));
    }
    if (options.tile < 0 || options.tile > kLargestTile || options.tile % 2 != 0) {
        throw Error(ErrorKind::Usage, "the tile is " + std::to_string(options.tile) +
                                          "; it must be an even number of voxels up to " +
                                          std::to_string(kLargestTile) + ", or 0 to choose it");
    }
}

double chooseVoxelSize(const BoundarySource& source, const DensityOptions& options) {
    if (options.voxelSize > 0) return options.voxelSize;
    const openvdb::Vec3d size = source.bounds().extents();
    return std::max({size.x(), size.y(), size.z()}) / options.resolution;
}

// Bytes that the grid and the work on it will take, from the surface's area. The factors are
// measured on meshes between 128³ and 1024³; they are meant to be a little high.
double estimateMemory(const BoundarySource& source, const TilePlan& plan, const TileLayout& layout,
                      const TileFilter& filter) {
    constexpr double kBytesPerLeaf = 2048 + 128;
    constexpr double kBorderShare = 1.4;  // blocks at the columns' borders exist twice for a while
    const double area = source.area() / (layout.voxelSize * layout.voxelSize);
    const double thickness = plan.halo + DensityLeaf::DIM;  // of the leaves along the surface
    const double leaves = area * thickness / DensityLeaf::SIZE;
    const double columns = static_cast<double>(layout.count.y()) * layout.count.z();
    const double perThread = 4.0 * static_cast<double>(filter.bufferSize()) +
                             4.0 * std::pow(plan.interior, 3) +
                             sizeof(SurfaceSample) * 8.0 * plan.side * plan.side;
    return leaves * kBytesPerLeaf * kBorderShare + columns * 2 * sizeof(ColumnBlocks) +
           12.0 * static_cast<double>(source.elementCount()) + threadCount() * perThread;
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

void warnOfFilter(const ExponentialFilter& filter, double tolerance,
                  std::vector<std::string>& warnings) {
    if (filter.atNyquist() <= tolerance) return;
    warnings.push_back("the lattice cannot hold a filter of order " + inShort(filter.order) +
                       " and cutoff " + inShort(filter.cutoff) + ": at its highest frequency " +
                       inShort(filter.atNyquist()) + " is left, above the tolerance of " +
                       inShort(tolerance));
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
    const double voxelSize = chooseVoxelSize(source, options);
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
    {
        const ProgressStage stage(progress, "assembling", 0);
        result.grid = assembleGrid(columns, {voxelSize, plan.threshold, clamp});
    }
    progress.throwIfInterrupted();
    if (result.grid->tree().empty()) {
        throw Error(ErrorKind::Result, source.name() + ": no voxel's density exceeds " +
                                           inShort(plan.threshold) + "; the grid would be empty");
    }
    result.grid->setName("density");
    result.grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    result.grid->setCreator(std::string("bandvox ") + version());

    DensityMetadata& metadata = result.metadata;
    metadata.version = version();
    metadata.source = source.name();
    metadata.order = options.filter.order;
    metadata.cutoff = options.filter.cutoff;
    metadata.iso = options.iso;
    metadata.tolerance = options.tolerance;
    metadata.closureError = statistics.closureError;
    metadata.sourceVolume = source.volume();
    metadata.gridVolume = densityIntegral(*result.grid);
    metadata.clamped = clamp;
    setDensityMetadata(*result.grid, metadata);

    result.surfaceSamples = statistics.samples;
    result.tiles = statistics.tiles;
    result.tileSide = plan.side;
    result.halo = plan.halo;
    result.kernelWidth = plan.kernel.width();
    result.minimum = statistics.minimum;
    result.maximum = statistics.maximum;
    result.spreadSeconds = statistics.spreadSeconds;
    result.transformSeconds = statistics.transformSeconds;
    return result;
}

}  // namespace bandvox
