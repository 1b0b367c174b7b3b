#include "bandlimit/exact_route.h"

#include "bandlimit/density_steps.h"
#include "bandlimit/spread_bricks.h"
#include "bandlimit/surface_quadrature.h"
#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/source/quadrature.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

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

double voxelSizeOf(const BoundarySource& source, const DensityOptions& options) {
    requireValid(options);
    return chooseVoxelSize(source.name(), source.bounds(), options);
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

// Points on a surface for each square voxel, as its elements are split: by up to twice as many as
// if the largest ones that a rule is for would fit.
double samplesPerArea(const SurfaceQuadrature& quadrature) {
    constexpr double kSplit = 2;
    const double triangle = std::sqrt(3.0) / 4;  // area of one whose sides are 1
    double fewest = std::numeric_limits<double>::max();
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        const double edge = quadrature.triangleEdge[static_cast<std::size_t>(rule)];
        if (!(edge > 0)) continue;
        const auto points = static_cast<double>(triangleRule(rule).size());
        fewest = std::min(fewest, points / (triangle * edge * edge));
    }
    return kSplit * fewest;
}

}  // namespace

ExactRoute::ExactRoute(const BoundarySource& surface, const DensityOptions& asked)
    : source(surface),
      options(asked),
      voxelSize(voxelSizeOf(surface, asked)),
      plan(makeTilePlan(asked)),
      layout(layOutTiles(surface.bounds(), voxelSize, plan)) {}

std::string ExactRoute::wanted() const {
    return "a grid of voxels of " + inShort(voxelSize) + " world units";
}

double ExactRoute::allowedError() const {
    return std::max(options.tolerance, options.filter.atNyquist());
}

// The quadrature takes the errors of a mesh's elements for independent. Of thousands that are alike
// and share a voxel, as of a comb finer than the lattice, they add up: then it has to be finer.
void ExactRoute::refine(int attempt, double error) {
    if (attempt == kMostRefinements || !(error <= kErrorOfHole)) {
        throw Error(ErrorKind::Result,
                    source.name() + ": the density is off by " + inShort(error) +
                        " where it should be a whole number, more than the tolerance of " +
                        inShort(plan.tolerance));
    }
    plan.quadrature =
        chooseQuadrature(plan.filter, plan.tolerance * std::pow(kRefinement, attempt + 1));
}

ExactRouteMemory::ExactRouteMemory(const ExactRoute& route, const TileFilter& filter)
    : columns(memoryOfColumns(route.layout)), bricks(0) {
    const TilePlan& plan = route.plan;
    const double area = route.source.area() / (route.voxelSize * route.voxelSize);
    const double thickness = 2 * plan.halo + DensityLeaf::DIM;  // of the leaves along the surface
    leaves = area * thickness / DensityLeaf::SIZE;
    const auto count = static_cast<double>(route.source.elementCount());
    thread = 4.0 * static_cast<double>(filter.bufferSize()) + 4.0 * std::pow(plan.interior, 3);
    if (SpreadBricks::payFor(route.source, route.voxelSize)) {
        elements = sizeof(std::uint32_t) * count;
        bricks = SpreadBricks::estimateMemory(route.source, plan, route.voxelSize);
        return;
    }
    // A tile of an ordinary shape holds about three times its own cross-section of the surface,
    // and of the elements that much, each with a sample at least.
    const double crossSection = static_cast<double>(plan.side) * plan.side;
    const double inTile = count * std::min(1.0, 3 * crossSection / area);
    constexpr double kGrowth = 2;  // of a vector that is filled without knowing its end
    const double samples = std::max(8.0, 3 * samplesPerArea(plan.quadrature)) * crossSection;
    thread += kGrowth * sizeof(SurfaceSample) * std::max(samples, inTile);
    // So many tiles along an axis meet an element of no size.
    const double tilesOfElement = 1 + 2.0 * (plan.halo + 1) / plan.interior;
    elements = sizeof(std::uint32_t) * count * tilesOfElement * (tilesOfElement + 1);
}

void stateMeasured(const ExactRoute& route, const ColumnStatistics& statistics,
                   DensityResult& result) {
    // Of a part it is not known whether others overlap; who joins them knows it.
    const bool isLimited = result.overlaps && route.options.shard.isWhole();
    if (isLimited) result.warnings.push_back(overlapWarning(statistics));
    DensityMetadata& metadata = result.metadata;
    metadata.source = route.source.name();
    metadata.route = "exact";
    metadata.closureError = statistics.closureError;
    metadata.sourceVolume = route.source.volume();
    metadata.clamped = isLimited || route.options.clamp;
}

void stateGrid(const ExactRoute& route, const ColumnStatistics& statistics, DensityResult& result) {
    const bool clamp = result.metadata.clamped;
    if (!clamp && route.options.shard.isWhole()) warnOfVolume(result.metadata, result.warnings);
    result.surfaceSamples = statistics.samples;
    result.tiles = statistics.tiles;
    result.kernelWidth = route.plan.kernel.width();
    result.minimum = clamp ? std::max(statistics.minimum, 0.0) : statistics.minimum;
    result.maximum = clamp ? std::min(statistics.maximum, 1.0) : statistics.maximum;
    result.spreadSeconds = statistics.spreadSeconds;
    result.transformSeconds = statistics.transformSeconds;
}

}  // namespace bandvox
