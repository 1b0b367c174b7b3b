#include "bandlimit/density_steps.h"

#include "bandlimit/grid_assembly.h"
#include "core/smallest_voxel.h"
#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/join_shards.h>

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

constexpr double kLowestTolerance = 1e-6;
constexpr double kHighestTolerance = 0.05;
constexpr int kHighestResolution = 1 << 20;
constexpr int kLargestTile = 512;
constexpr double kLargestVoxel = 1e60;  // world units; the volumes of many are still finite

}  // namespace

void requireValid(const DensityOptions& options) {
    requireValid(options.filter);
    requireValid(options.shard);
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
    if (!(options.iso > 0 && options.iso < 1)) {
        throw Error(ErrorKind::Usage,
                    "the iso-value is " + inShort(options.iso) + "; it must lie between 0 and 1");
    }
    if (options.tile < 0 || options.tile > kLargestTile || options.tile % 2 != 0) {
        throw Error(ErrorKind::Usage, "the tile is " + std::to_string(options.tile) +
                                          "; it must be an even number of voxels up to " +
                                          std::to_string(kLargestTile) + ", or 0 to choose it");
    }
}

double chooseVoxelSize(const std::string& source, const openvdb::BBoxd& bounds,
                       const DensityOptions& options) {
    double voxelSize = options.voxelSize;
    if (voxelSize == 0) {
        const openvdb::Vec3d size = bounds.extents();
        voxelSize = std::max({size.x(), size.y(), size.z()}) / options.resolution;
    }
    if (voxelSize < kSmallestVoxel) {
        throw Error(options.voxelSize > 0 ? ErrorKind::Usage : ErrorKind::Input,
                    source + ": a voxel would be " + inShort(voxelSize) +
                        " world units, and OpenVDB's transforms take no less than " +
                        inShort(kSmallestVoxel) +
                        (options.voxelSize > 0 ? "; use larger ones" : "; scale the object up"));
    }
    if (!(voxelSize <= kLargestVoxel)) {
        throw Error(options.voxelSize > 0 ? ErrorKind::Usage : ErrorKind::Input,
                    source + ": a voxel would be " + inShort(voxelSize) +
                        " world units; it must be at most " + inShort(kLargestVoxel));
    }
    return voxelSize;
}

double memoryOfGrid(double leaves) {
    constexpr double kBorderShare = 2;       // blocks at the columns' borders exist in pieces first
    constexpr double kNodesPerLeaf = 120.0;  // bytes of the nodes above, along a surface
    return leaves * (kBytesOfLeaf * kBorderShare + kNodesPerLeaf);
}

double memoryOfColumns(const TileLayout& layout) {
    const double columns = static_cast<double>(layout.count.y()) * layout.count.z();
    return columns * (2 * sizeof(ColumnBlocks) + sizeof(float) * layout.count.x());
}

void warnOfFilter(const ExponentialFilter& filter, double tolerance,
                  std::vector<std::string>& warnings) {
    if (filter.atNyquist() <= tolerance) return;
    warnings.push_back("the lattice cannot hold a filter of order " + inShort(filter.order) +
                       " and cutoff " + inShort(filter.cutoff) + ": at its highest frequency " +
                       inShort(filter.atNyquist()) + " is left, above the tolerance of " +
                       inShort(tolerance));
}

void describeGrid(const DensityOptions& options, const TileGeometry& geometry, double integral,
                  DensityResult& result) {
    DensityMetadata& metadata = result.metadata;
    if (result.grid->tree().empty() && options.shard.isWhole()) {
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
    metadata.gridVolume = integral;
    setDensityMetadata(*result.grid, metadata);
    setShardMetadata(*result.grid, {options.shard, result.overlaps, result.refinements});
    result.tileSide = geometry.side;
    result.halo = geometry.halo;
}

void finishGrid(std::vector<ColumnBlocks>& columns, const TileLayout& layout,
                const DensityOptions& options, const TileGeometry& geometry, DensityResult& result,
                Progress& progress) {
    {
        const ProgressStage stage(progress, "assembling", 0);
        result.grid = assembleGrid(
            columns, layout,
            {geometry.threshold, result.metadata.clamped, /*isPart=*/!options.shard.isWhole()});
    }
    progress.throwIfInterrupted();
    describeGrid(options, geometry, densityIntegral(*result.grid), result);
}

}  // namespace bandvox
