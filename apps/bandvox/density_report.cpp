#include "density_report.h"

#include "words.h"

#include <bandvox/grid/join_shards.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>

namespace bandvox::app {

namespace {

void sayVolume(CommandRun& run, const DensityMetadata& metadata) {
    const double difference =
        metadata.sourceVolume != 0
            ? std::abs(metadata.gridVolume - metadata.sourceVolume) / metadata.sourceVolume
            : 0;
    run.say("volume   source " + formatNumber(metadata.sourceVolume, 8) + ", grid " +
            formatNumber(metadata.gridVolume, 8) + ", relative difference " +
            formatNumber(difference, 2));
}

}  // namespace

void sayDensity(CommandRun& run, const DensityResult& result, const std::string& error) {
    const DensityMetadata& metadata = result.metadata;
    const auto activeVoxels = static_cast<std::int64_t>(result.grid->activeVoxelCount());
    const openvdb::Coord size = result.grid->evalActiveVoxelBoundingBox().dim();
    run.say("grid     " + std::to_string(size.x()) + " x " + std::to_string(size.y()) + " x " +
            std::to_string(size.z()) + " voxels of side " +
            formatNumber(result.grid->voxelSize().x()) + ", " +
            formatCount(activeVoxels, "active voxel", "active voxels") + ", density " +
            formatNumber(result.minimum) + " to " + formatNumber(result.maximum));
    run.sayMore(
        "tiles    " + std::to_string(result.tiles) + " of side " + std::to_string(result.tileSide) +
        " with a halo of " + std::to_string(result.halo) +
        (result.fieldSamples > 0
             ? ", from " + formatCount(result.fieldSamples, "sample", "samples")
             : ", spread over " + std::to_string(result.kernelWidth) + " voxels from " +
                   formatCount(result.surfaceSamples, "surface sample", "surface samples")));
    run.say("error    " + error);
    if (const auto part = shardMetadata(*result.grid)) {
        run.say("part     " + std::to_string(part->shard.index) + " of " +
                std::to_string(part->shard.count) + ", with a volume of " +
                formatNumber(metadata.gridVolume, 8) + " of " +
                formatNumber(metadata.sourceVolume, 8));
    } else {
        sayVolume(run, metadata);
    }

    run.count("active_voxels", activeVoxels);
    run.count("surface_samples", result.surfaceSamples);
    run.count("field_samples", result.fieldSamples);
    run.count("tiles", result.tiles);
    run.count("tile_side", result.tileSide);
    run.count("halo", result.halo);
    run.count("kernel_width", result.kernelWidth);
    run.count("spread_thread_seconds", result.spreadSeconds);
    run.count("transform_thread_seconds", result.transformSeconds);
    run.count("closure_error", metadata.closureError);
    run.count("sampling_error", metadata.samplingError);
    run.count("storage_error", metadata.storageError);
    run.count("source_volume", metadata.sourceVolume);
    run.count("grid_volume", metadata.gridVolume);
}

}  // namespace bandvox::app
