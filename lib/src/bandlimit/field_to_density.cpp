#include "bandlimit/density_steps.h"
#include "bandlimit/field_column.h"
#include "bandlimit/field_memory.h"
#include "bandlimit/tile_plan.h"
#include "core/words.h"
#include "core/worker_pool.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>

namespace bandvox {

namespace {

constexpr int kHighestOversample = 64;

// By how much the error may exceed the difference that is measured. Half of the samples miss a
// flat face by exactly as much more as all of them do at worst; where faces meet, or lie opposite
// each other in a thin part, their errors may add up while the differences do not
// (docs/math/sampled-route.md).
constexpr double kSafety = 2;

void requireValid(const FieldDensityOptions& options) {
    requireValid(options.density);
    if (options.oversample < 1 || options.oversample > kHighestOversample) {
        throw Error(ErrorKind::Usage, "the oversampling is " + std::to_string(options.oversample) +
                                          "; it must be between 1 and " +
                                          std::to_string(kHighestOversample));
    }
    if (!(options.samplingTolerance >= 0)) {
        throw Error(ErrorKind::Usage, "the tolerance of the sampling is " +
                                          inShort(options.samplingTolerance) +
                                          "; it must not be negative");
    }
}

void requireBounds(const FieldSource& source) {
    const openvdb::BBoxd bounds = source.bounds();
    for (int axis = 0; axis < 3; ++axis) {
        // Written so that a NaN fails too.
        if (!(bounds.max()[axis] > bounds.min()[axis])) {
            throw Error(ErrorKind::Result,
                        source.name() + ": the field is 0 everywhere; the grid would be empty");
        }
    }
}

double estimateMemory(const FieldSource& source, const TileGeometry& geometry,
                      const TileLayout& layout, double perThread) {
    // The columns alone may be too many; then there is no need to look closer.
    const double least = memoryOfColumns(layout);
    if (least > static_cast<double>(availableMemory())) return least;
    return least + memoryOfGrid(estimateVaryingBlocks(source, geometry, layout)) +
           threadCount() * perThread;
}

// Fills the columns of tiles of a part, in parallel.
std::vector<ColumnBlocks> fillColumns(const FieldSampling& sampling, const Shard& shard,
                                      FieldStatistics& statistics, Progress& progress) {
    const openvdb::Coord& tiles = sampling.layout.count;
    const std::int64_t count = static_cast<std::int64_t>(tiles.y()) * tiles.z();
    std::vector<ColumnBlocks> columns(count);
    std::vector<FieldStatistics> perColumn(count);
    WorkerPool<FieldColumn> pool([&] { return std::make_unique<FieldColumn>(sampling); });
    const ProgressStage stage(progress, "band-limiting", count * tiles.x());
    parallelFor(count, [&](std::int64_t i) {
        if (!shard.holds(i)) return progress.advance(tiles.x());
        std::unique_ptr<FieldColumn> worker = pool.take();
        columns[i] = worker->fill(static_cast<int>(i / tiles.z()), static_cast<int>(i % tiles.z()),
                                  perColumn[i], progress);
        pool.giveBack(std::move(worker));
    });
    for (const FieldStatistics& column : perColumn) statistics.add(column);
    return columns;
}

// The bound on what the samples cannot tell, and a warning if it is too large or not known.
double findSamplingError(const FieldStatistics& statistics, const FieldDensityOptions& options,
                         std::vector<std::string>& warnings) {
    if (options.oversample % 2 != 0) {
        warnings.push_back("the sampling error is not known: an oversampling of " +
                           std::to_string(options.oversample) +
                           " cannot be halved to compare with; expected an even number");
        return std::numeric_limits<double>::quiet_NaN();
    }
    const double error = kSafety * statistics.difference;
    if (error > options.samplingTolerance) {
        warnings.push_back("the sampling error is up to " + inShort(error) +
                           ", above the tolerance of " + inShort(options.samplingTolerance) +
                           "; an oversampling of more than " + std::to_string(options.oversample) +
                           " lowers it");
    }
    return error;
}

}  // namespace

DensityResult fieldToDensity(const FieldSource& source, const FieldDensityOptions& options,
                             Progress& progress) {
    // Decide how the work is cut up, and whether it fits.
    requireValid(options);
    requireBounds(source);
    const DensityOptions& density = options.density;
    const double voxelSize = chooseVoxelSize(source.name(), source.bounds(), density);
    const TileGeometry geometry = makeTileGeometry(density);
    const TileLayout layout = layOutTiles(source.bounds(), voxelSize, geometry);
    const TileReduction fine(geometry, options.oversample);
    std::optional<TileReduction> coarse;
    if (options.oversample % 2 == 0) coarse.emplace(geometry, options.oversample / 2);
    const double perThread = fine.memory() + (coarse ? coarse->memory() : 0);
    requireMemory(estimateMemory(source, geometry, layout, perThread),
                  ("a grid of voxels of " + inShort(voxelSize) + " world units").c_str());

    // Sample and filter the tiles, and look at what was measured on the way.
    DensityResult result;
    warnOfFilter(density.filter, density.tolerance, result.warnings);
    FieldStatistics statistics;
    std::vector<ColumnBlocks> columns =
        fillColumns({source, layout, options.oversample, fine, coarse ? &*coarse : nullptr},
                    density.shard, statistics, progress);

    // Join the columns to one grid.
    DensityMetadata& metadata = result.metadata;
    metadata.source = source.name();
    metadata.route = "sampled";
    metadata.oversampling = options.oversample;
    metadata.samplingError = findSamplingError(statistics, options, result.warnings);
    metadata.clamped = density.clamp;
    finishGrid(columns, layout, density, geometry, result, progress);

    result.fieldSamples = statistics.samples;
    result.tiles = statistics.tiles;
    result.minimum = density.clamp ? std::max(statistics.minimum, 0.0) : statistics.minimum;
    result.maximum = density.clamp ? std::min(statistics.maximum, 1.0) : statistics.maximum;
    result.spreadSeconds = statistics.sampleSeconds;
    result.transformSeconds = statistics.transformSeconds;
    return result;
}

}  // namespace bandvox
