#include "bandlimit/density_steps.h"

#include "bandlimit/grid_assembly.h"

#include <bandvox/core/error.h>
#include <bandvox/core/version.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bandvox {

namespace {

constexpr double kLowestTolerance = 1e-6;
constexpr double kHighestTolerance = 0.05;
constexpr int kHighestResolution = 1 << 20;
constexpr int kLargestTile = 512;

}  // namespace

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

double chooseVoxelSize(const openvdb::BBoxd& bounds, const DensityOptions& options) {
    if (options.voxelSize > 0) return options.voxelSize;
    const openvdb::Vec3d size = bounds.extents();
    return std::max({size.x(), size.y(), size.z()}) / options.resolution;
}

double memoryOfGrid(double leaves, const TileLayout& layout) {
    constexpr double kBytesPerLeaf = 2048 + 128;
    constexpr double kBorderShare = 1.4;  // blocks at the columns' borders exist twice for a while
    const double columns = static_cast<double>(layout.count.y()) * layout.count.z();
    return leaves * kBytesPerLeaf * kBorderShare + columns * 2 * sizeof(ColumnBlocks);
}

void warnOfFilter(const ExponentialFilter& filter, double tolerance,
                  std::vector<std::string>& warnings) {
    if (filter.atNyquist() <= tolerance) return;
    warnings.push_back("the lattice cannot hold a filter of order " + inShort(filter.order) +
                       " and cutoff " + inShort(filter.cutoff) + ": at its highest frequency " +
                       inShort(filter.atNyquist()) + " is left, above the tolerance of " +
                       inShort(tolerance));
}

void finishGrid(std::vector<ColumnBlocks>& columns, double voxelSize, const DensityOptions& options,
                const TileGeometry& geometry, DensityResult& result, Progress& progress) {
    DensityMetadata& metadata = result.metadata;
    {
        const ProgressStage stage(progress, "assembling", 0);
        result.grid = assembleGrid(columns, {voxelSize, geometry.threshold, metadata.clamped});
    }
    progress.throwIfInterrupted();
    if (result.grid->tree().empty()) {
        throw Error(ErrorKind::Result, metadata.source + ": no voxel's density exceeds " +
                                           inShort(geometry.threshold) +
                                           "; the grid would be empty");
    }
    result.grid->setName("density");
    result.grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    result.grid->setCreator(std::string("bandvox ") + version());

    metadata.version = version();
    metadata.order = options.filter.order;
    metadata.cutoff = options.filter.cutoff;
    metadata.iso = options.iso;
    metadata.tolerance = options.tolerance;
    metadata.gridVolume = densityIntegral(*result.grid);
    setDensityMetadata(*result.grid, metadata);
    result.tileSide = geometry.side;
    result.halo = geometry.halo;
}

}  // namespace bandvox
