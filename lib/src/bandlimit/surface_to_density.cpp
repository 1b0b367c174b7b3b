#include "bandlimit/density_column.h"
#include "bandlimit/element_bins.h"
#include "bandlimit/grid_assembly.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/words.h"
#include "core/worker_pool.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace bandvox {

namespace {

constexpr double kLowestTolerance = 1e-6;
constexpr double kHighestTolerance = 0.05;
constexpr int kHighestResolution = 1 << 20;
constexpr int kLargestTile = 512;
constexpr double kSmallestVoxel = 1e-14;  // world units; a scale below 1e-15 is 0 to OpenVDB

// How far the integral may be from the volume, in tolerances, before it is worth a word.
constexpr double kVolumeMargin = 10;

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
    double voxelSize = options.voxelSize;
    if (voxelSize == 0) {
        const openvdb::Vec3d size = source.bounds().extents();
        voxelSize = std::max({size.x(), size.y(), size.z()}) / options.resolution;
    }
    if (voxelSize < kSmallestVoxel) {
        throw Error(options.voxelSize > 0 ? ErrorKind::Usage : ErrorKind::Input,
                    source.name() + ": a voxel would be " + inShort(voxelSize) +
                        " world units, and OpenVDB's transforms take no less than " +
                        inShort(kSmallestVoxel) + "; scale the object up");
    }
    return voxelSize;
}

// Bytes that the grid will take, from the surface's area: its leaves, those at the columns'
// borders twice for a while, and the inner nodes above them. A little high, by measurements on
// meshes between 128³ and 1024³.
double estimateGridMemory(const BoundarySource& source, double voxelSize, const TilePlan& plan) {
    constexpr double kBytesPerLeaf = 2048 + 128;
    constexpr double kBorderShare = 2;
    constexpr double kBytesPerNode = 36e3;
    constexpr double kNodeFace = 128 * 128;
    const double area = source.area() / (voxelSize * voxelSize);
    const double thickness = 2 * plan.halo + DensityLeaf::DIM;  // of the leaves along the surface
    const double leaves = area * thickness / DensityLeaf::SIZE;
    return leaves * kBytesPerLeaf * kBorderShare + 2 * area / kNodeFace * kBytesPerNode;
}

// Bytes that the work on it takes besides.
double estimateWorkMemory(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter) {
    const double columns = static_cast<double>(layout.count.y()) * layout.count.z();
    const double perThread = 4.0 * static_cast<double>(filter.bufferSize()) +
                             4.0 * std::pow(plan.interior, 3) +
                             sizeof(SurfaceSample) * 8.0 * plan.side * plan.side;
    return columns * (2 * sizeof(ColumnBlocks) + sizeof(float) * layout.count.x()) +
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
    const double voxelSize = chooseVoxelSize(source, options);
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
    {
        const ProgressStage stage(progress, "assembling", 0);
        result.grid = assembleGrid(columns, layout, {plan.threshold, clamp});
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
    if (!clamp) warnOfVolume(metadata, result.warnings);

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
