#include "core/smallest_voxel.h"
#include "core/words.h"
#include "core/worker_pool.h"
#include "resample/block_filter.h"
#include "resample/lattice_map.h"
#include "resample/source_grid.h"
#include "resample/target_grid.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/array_box.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/join_shards.h>
#include <bandvox/resample/resample_grid.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

using openvdb::Coord;

// Steps larger than this are made of several: the reach of a filter grows with them.
constexpr double kLargestStep = 3;
// On the way, a share of the tolerance.
constexpr double kBetweenShare = 0.25;

// What is left of the tolerance for values that are stored as the background; as in convert.
constexpr double kStorageShare = 3.0 / 8;

void requireLinear(const openvdb::math::Transform& transform, ErrorKind kind) {
    if (transform.isLinear() &&
        std::abs(transform.baseMap()->getAffineMap()->getMat4().det()) > 0) {
        return;
    }
    throw Error(kind, "a transform of type " + transform.mapType() +
                          " is no lattice that can be resampled; expected a linear one");
}

void requireValid(const ResampleOptions& options) {
    requireValid(options.shard);
    if (options.filter) requireValid(*options.filter);
    if (!(options.tolerance >= 1e-6 && options.tolerance <= 0.05)) {
        throw Error(ErrorKind::Usage, "the tolerance of resampling is " +
                                          inShort(options.tolerance) + "; it must be 1e-6 to 0.05");
    }
}

// What one thread works with.
struct Worker {
    Worker(const openvdb::FloatGrid& grid, const BlockFilter& filter)
        : reader(grid),
          scratch(filter.allocate()),
          values(static_cast<std::size_t>(filter.blockSide()) * filter.blockSide() *
                 filter.blockSide()) {}

    SourceReader reader;
    BlockFilter::Scratch scratch;
    std::vector<float> values;
};

// One step from lattice to lattice.
struct Step {
    const openvdb::FloatGrid& source;
    ValueRange range;  // of its values
    LatticeFilter filter;
    bool isDensity;
    Shard shard = {};

    double amplitude() const {
        const double background = source.background();
        return std::max(range.high - background, background - range.low);
    }
};

StorageRule storageRule(const Step& step) {
    const double threshold = kStorageShare * step.filter.tolerance * step.amplitude();
    return {step.source.background(),
            static_cast<float>(threshold),
            {step.range.low, step.range.high},
            step.isDensity};
}

void requireMemoryFor(const BlockFilter& filter, std::size_t blocks) {
    // A leaf for each 8³ voxels, if none becomes a tile, is far too much for sparse grids: ask for
    // what the threads' work takes, and for a surface through each block.
    constexpr double kLeafBytes = 2200;
    const double leavesAlong = filter.blockSide() / 8.0;
    requireMemory(static_cast<double>(blocks) * leavesAlong * leavesAlong * kLeafBytes +
                      filter.scratchBytes() * (threadCount() + 1),
                  "the new grid");
}

openvdb::FloatGrid::Ptr runStep(const Step& step, const openvdb::math::Transform& target,
                                ResampleResult& result, Progress& progress) {
    const LatticeMap map(step.source.transform(), target);
    const std::unique_ptr<BlockFilter> maker = makeBlockFilter(map, step.filter);
    const BlockFilter& filter = *maker;
    const std::vector<Coord> blocks = blocksNear(step.source, map, filter);
    requireMemoryFor(filter, blocks.size());
    const StorageRule rule = storageRule(step);

    std::vector<GridPart> parts(blocks.size());
    std::atomic<std::int64_t> transformed{0};
    WorkerPool<Worker> workers([&] { return std::make_unique<Worker>(step.source, filter); });
    {
        const ProgressStage stage(progress, "filtering", static_cast<std::int64_t>(blocks.size()));
        parallelFor(static_cast<std::int64_t>(blocks.size()), [&](std::int64_t i) {
            progress.throwIfInterrupted();
            if (!step.shard.holds(i)) {
                return progress.advance();
            }
            const Coord& block = blocks[static_cast<std::size_t>(i)];
            GridPart& part = parts[static_cast<std::size_t>(i)];
            const int side = filter.blockSide();
            const Coord origin(block[0] * side, block[1] * side, block[2] * side);
            auto worker = workers.take();
            if (const auto same = worker->reader.constantIn(filter.sourceBox(block))) {
                if (same->value != rule.background || same->active) {
                    part.addConstant(origin, side, same->value, same->active);
                }
            } else {
                worker->reader.copy(filter.sourceCube(block), worker->scratch.cube.get());
                filter.apply(block, worker->scratch, worker->values);
                part.addCube(origin, side, worker->values, rule);
                ++transformed;
            }
            workers.giveBack(std::move(worker));
            progress.advance();
        });
    }

    auto grid = openvdb::FloatGrid::create(rule.background);
    result.minimum = result.maximum = rule.background;
    for (GridPart& part : parts) {
        result.minimum = std::min<double>(result.minimum, part.minimum());
        result.maximum = std::max<double>(result.maximum, part.maximum());
        part.moveTo(grid->tree());
    }
    openvdb::tools::pruneTiles(grid->tree(), 0.0F, /*threaded=*/false);
    grid->setTransform(target.copy());
    ++result.steps;
    result.blocks += transformed;
    return grid;
}

// A lattice with half as many voxels along the axes in which the target is far coarser; null if
// there is none.
openvdb::math::Transform::Ptr halfWay(const openvdb::math::Transform& source,
                                      const openvdb::math::Transform& target) {
    const LatticeMap map(source, target);
    if (map.coarsest() <= kLargestStep) return nullptr;
    openvdb::Vec3d factor(1.0);
    bool isCoarser = false;
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d unit(0.0);
        unit[axis] = 1;
        if (map.frequency(unit) < kLargestStep) continue;
        factor[axis] = 2;
        isCoarser = true;
    }
    if (!isCoarser) return nullptr;
    openvdb::math::Transform::Ptr between = source.copy();
    between->preScale(factor);
    return between;
}

// A filter for the way, that leaves all that the next lattice needs: Gaussians are the quickest.
ExponentialFilter filterBetween(const ExponentialFilter& last) {
    constexpr ExponentialFilter kGaussian{2, 0.16}, kSharp{4, 0.25};
    return last.order == 2 && last.cutoff <= kGaussian.cutoff ? kGaussian : kSharp;
}

// The filter of a density, in cycles per voxel of the lattice it is on now.
std::optional<ExponentialFilter> filterOf(const std::optional<DensityMetadata>& metadata) {
    if (!metadata) return std::nullopt;
    return ExponentialFilter{metadata->order, metadata->cutoff};
}

// Says of a new grid what is in it.
void describeResult(openvdb::FloatGrid& grid, const openvdb::FloatGrid& source,
                    const ResampleOptions& options, double largestStep) {
    static_cast<openvdb::MetaMap&>(grid) = static_cast<const openvdb::MetaMap&>(source);
    setShardMetadata(grid, {options.shard, false, 0});
    dropArrayBox(grid);
    std::optional<DensityMetadata> metadata = densityMetadata(source);
    const std::optional<ExponentialFilter> kept =
        options.filter ? options.filter : filterOf(metadata);
    if (!kept) return;
    if (!metadata) {
        metadata.emplace();
        metadata->version = version();
        metadata->route = "filtered";
    }
    metadata->order = kept->order;
    // On a lattice that is finer along all axes, what it holds ends where the old one's did;
    // without a filter that is so on any lattice.
    const double step = options.filter ? std::min(largestStep, 1.0) : largestStep;
    metadata->cutoff = std::clamp(kept->cutoff * step, 0.01, 0.5);
    metadata->tolerance = std::max(metadata->tolerance, options.tolerance);
    metadata->gridVolume = densityIntegral(grid);
    setDensityMetadata(grid, *metadata);
}

}  // namespace

ResampleResult resampleGrid(const openvdb::FloatGrid::ConstPtr& source,
                            const openvdb::math::Transform& target, const ResampleOptions& options,
                            Progress& progress) {
    if (!source) throw Error(ErrorKind::Usage, "resampling needs a grid, but got none");
    requireValid(options);
    requireLinear(source->transform(), ErrorKind::Input);
    requireLinear(target, ErrorKind::Usage);

    ResampleResult result;
    const std::optional<DensityMetadata> metadata = densityMetadata(*source);
    std::optional<ExponentialFilter> before = filterOf(metadata);
    openvdb::FloatGrid::ConstPtr grid = source;
    if (options.filter) {
        const ExponentialFilter onTheWay = filterBetween(*options.filter);
        while (const auto between = halfWay(grid->transform(), target)) {
            const Step step{*grid,
                            finiteRange(*grid),
                            {onTheWay, before, kBetweenShare * options.tolerance},
                            metadata.has_value()};
            grid = runStep(step, *between, result, progress);
            before = onTheWay;
        }
    }
    const Step last{*grid,
                    finiteRange(*grid),
                    {options.filter, before, options.tolerance},
                    metadata.has_value(),
                    options.shard};
    result.amplitude = last.amplitude();
    result.grid = runStep(last, target, result, progress);
    describeResult(*result.grid, *source, options,
                   LatticeMap(source->transform(), target).largestStep());
    return result;
}

openvdb::math::Transform::Ptr uniformLattice(const openvdb::GridBase& grid, double voxelSize) {
    if (!(voxelSize > 0 && std::isfinite(voxelSize))) {
        throw Error(ErrorKind::Usage,
                    "the side of a voxel is " + inShort(voxelSize) + "; it must be above 0");
    }
    if (voxelSize < kSmallestVoxel) {
        throw Error(ErrorKind::Usage, "the side of a voxel is " + inShort(voxelSize) +
                                          ", and OpenVDB's transforms take no less than " +
                                          inShort(kSmallestVoxel));
    }
    requireLinear(grid.transform(), ErrorKind::Input);
    openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    for (int row = 0; row < 3; ++row) {
        const double length =
            openvdb::Vec3d(matrix(row, 0), matrix(row, 1), matrix(row, 2)).length();
        for (int column = 0; column < 3; ++column) matrix(row, column) *= voxelSize / length;
    }
    return openvdb::math::Transform::createLinearTransform(matrix);
}

}  // namespace bandvox
