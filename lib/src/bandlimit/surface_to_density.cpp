#include "bandlimit/density_steps.h"
#include "bandlimit/fill_columns.h"
#include "bandlimit/find_overlap.h"
#include "bandlimit/spread_bricks.h"
#include "bandlimit/surface_quadrature.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace bandvox {

namespace {

// How far the integral may be from the volume, relative, before it is worth a word, if the
// tolerance is no more than that.
constexpr double kVolumeError = 1e-4;

// How often a quadrature that turns out too coarse is refined, and to what part of its tolerance;
// and the error beyond which it is none of the quadrature's, but of a surface that is not closed.
constexpr int kMostRefinements = 2;
constexpr double kRefinement = 1e-2;
constexpr double kErrorOfHole = 0.02;

// Bytes that the grid will take, from the surface's area.
double estimateGridMemory(const BoundarySource& source, double voxelSize, const TilePlan& plan) {
    const double area = source.area() / (voxelSize * voxelSize);
    const double thickness = 2 * plan.halo + DensityLeaf::DIM;  // of the leaves along the surface
    return memoryOfGrid(area * thickness / DensityLeaf::SIZE);
}

// Bytes that the work on it takes besides.
double estimateWorkMemory(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter) {
    const auto elements = static_cast<double>(source.elementCount());
    const double crossSection = static_cast<double>(plan.side) * plan.side;
    const double area = source.area() / (layout.voxelSize * layout.voxelSize);
    const double ofThread =
        4.0 * static_cast<double>(filter.bufferSize()) + 4.0 * std::pow(plan.interior, 3);
    if (SpreadBricks::payFor(source, layout.voxelSize)) {
        return memoryOfColumns(layout) + sizeof(std::uint32_t) * elements +
               SpreadBricks::estimateMemory(source, plan, layout.voxelSize) +
               threadCount() * ofThread;
    }
    // A tile of an ordinary shape holds about three times its own cross-section of the surface,
    // and of the elements that much, each with a sample at least.
    const double inTile = elements * std::min(1.0, 3 * crossSection / area);
    constexpr double kGrowth = 2;  // of a vector that is filled without knowing its end
    const double perThread =
        ofThread + kGrowth * sizeof(SurfaceSample) * std::max(8 * crossSection, inTile);
    // So many tiles along an axis meet an element of no size.
    const double tilesOfElement = 1 + 2.0 * (plan.halo + 1) / plan.interior;
    const double bins = sizeof(std::uint32_t) * elements * tilesOfElement * (tilesOfElement + 1);
    return memoryOfColumns(layout) + bins + threadCount() * perThread;
}

/// Which columns are filled, and how well.
struct ColumnWork {
    std::vector<bool> wanted;  ///< empty for all
    double allowed;            ///< distance from whole numbers away from the surface
};

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
//
// The quadrature takes the errors of a mesh's elements for independent. Of thousands that are alike
// and share a voxel, as of a comb finer than the lattice, they add up: then it has to be finer.
FilledColumns fillToTolerance(const BoundarySource& source, TilePlan plan, const TileLayout& layout,
                              const TileFilter& filter, const ColumnWork& work, int& refinements,
                              Progress& progress) {
    for (int attempt = 0;; ++attempt) {
        FilledColumns columns =
            fillColumns(source, plan, layout, filter, "band-limiting", progress, work.wanted);
        const double error = columns.total().closureError;
        refinements = attempt;
        if (error <= work.allowed) return columns;
        if (attempt == kMostRefinements || !(error <= kErrorOfHole)) {
            throw Error(ErrorKind::Result,
                        source.name() + ": the density is off by " + inShort(error) +
                            " where it should be a whole number, more than the tolerance of " +
                            inShort(plan.tolerance));
        }
        plan.quadrature =
            chooseQuadrature(plan.filter, plan.tolerance * std::pow(kRefinement, attempt + 1));
    }
}

// What the user should know of shells that overlap.
std::string overlapWarning(const ColumnStatistics& statistics) {
    return "parts of the surface overlap or are inside out (density from " +
           inShort(statistics.minimum) + " to " + inShort(statistics.maximum) +
           "); it was limited to [0, 1], and its integral is not the volume";
}

// What lies below the storage threshold is lost, and of an object of few voxels that is much.
void warnOfVolume(const DensityMetadata& metadata, std::vector<std::string>& warnings) {
    const double difference = std::abs(metadata.gridVolume / metadata.sourceVolume - 1);
    if (difference <= std::max(kVolumeError, metadata.tolerance)) return;
    const bool isHeld =
        ExponentialFilter{metadata.order, metadata.cutoff}.atNyquist() <= metadata.tolerance;
    warnings.push_back("the integral of the density differs from the volume by " +
                       inShort(100 * difference) +
                       (isHeld ? " %, since the object is small in voxels; use more of them, or a "
                                 "smaller tolerance"
                               : " %, since the lattice cannot hold the filter"));
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
    // What the lattice cannot hold keeps ringing away from the surface; it was warned of.
    FilledColumns columns = fillToTolerance(
        source, plan, layout, filter,
        {columnsOf(options.shard, layout), std::max(options.tolerance, options.filter.atNyquist())},
        result.refinements, progress);
    const ColumnStatistics statistics = columns.total();
    result.overlaps =
        !options.sumOverlaps && findOverlap(source, options, layout, columns.statistics, progress);
    // Of a part it is not known whether others overlap; who joins them knows it.
    const bool isLimited = result.overlaps && options.shard.isWhole();
    if (isLimited) result.warnings.push_back(overlapWarning(statistics));
    const bool clamp = isLimited || options.clamp;

    // Join the columns to one grid.
    DensityMetadata& metadata = result.metadata;
    metadata.source = source.name();
    metadata.route = "exact";
    metadata.closureError = statistics.closureError;
    metadata.sourceVolume = source.volume();
    metadata.clamped = clamp;
    finishGrid(columns.blocks, layout, options, plan, result, progress);
    if (!clamp && options.shard.isWhole()) warnOfVolume(metadata, result.warnings);

    result.surfaceSamples = statistics.samples;
    result.tiles = statistics.tiles;
    result.kernelWidth = plan.kernel.width();
    result.minimum = clamp ? std::max(statistics.minimum, 0.0) : statistics.minimum;
    result.maximum = clamp ? std::min(statistics.maximum, 1.0) : statistics.maximum;
    result.spreadSeconds = statistics.spreadSeconds;
    result.transformSeconds = statistics.transformSeconds;
    return result;
}

}  // namespace bandvox
