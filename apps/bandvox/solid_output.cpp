#include "solid_output.h"

#include "convert_volume.h"
#include "memory_limit.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/resample/detail_levels.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace bandvox::app {
namespace {

constexpr int kLargestTile = 512;

ResampleOptions levelOptions(const DensityOptions& density) {
    ResampleOptions options;
    options.filter = density.filter;
    options.tolerance = std::max(density.tolerance, options.tolerance);
    return options;
}

void addLevels(CommandRun& run, const SolidOutput& output, const DensityOptions& density,
               const openvdb::FloatGrid::Ptr& grid, openvdb::GridCPtrVec& written) {
    const ResampleOptions options = levelOptions(density);
    for (const auto& level : makeDetailLevels(grid, output.levels, options, run.progress())) {
        if (output.write.half) roundAndRestate(*level);
        run.say("level    " + level->getName() + ": " +
                formatCount(static_cast<std::int64_t>(level->activeVoxelCount()), "active voxel",
                            "active voxels") +
                " of side " + formatNumber(level->voxelSize().x()));
        written.push_back(level);
    }
}

}  // namespace

std::optional<AtomicFile> SolidOutput::openFile() const {
    if (array) return std::nullopt;
    return std::optional<AtomicFile>(std::in_place, path);
}

SolidOutput readSolidOutput(const CommandLine& line, const std::string& noun) {
    SolidOutput output;
    const std::string name = line.requiredText("output");
    output.array = ArrayOutput::read(line);
    if (!output.array) output.mesh = readVdbOrMeshOutput(line);
    output.path = outputPath(name);
    if (asksForValues(line)) {
        throw Error(ErrorKind::Usage, "--as values is for volumes, and '" + line.positional(0) +
                                          "' is " + noun + "; expected density, level-set or fog");
    }
    output.kind = readOutputKind(line).value_or(OutputKind());
    output.iso = readIso(line, {.low = 0, .high = 1, .lowOpen = true, .highOpen = true});
    output.levels = readDetailLevels(line);
    output.write.half = line.has("half");
    if (!output.array) output.write.compression = readCompression(line);
    output.memoryLimit = readMemoryLimit(line);
    return output;
}

void readDensityOptions(const CommandLine& line, const SolidOutput& output,
                        DensityOptions& density) {
    density.filter = readFilter(line, density.filter);
    density.tile = line.wholeNumber("tile", 0, kLargestTile, density.tile);
    if (density.tile % 2 != 0) line.fail("tile", "an even number");
    density.clamp = line.has("clamp");
    density.iso = output.iso.value.value_or(density.iso);
    density.shard = readShard(line);
    if (!density.shard.isWhole() && output.kind.kind != OutputKind::Kind::Density) {
        throw Error(ErrorKind::Usage,
                    "--as level-set or fog needs the whole, and --shard asks for a part; convert "
                    "what is merged");
    }
}

void finishDensity(CommandRun& run, const SolidOutput& output, const openvdb::FloatGrid::Ptr& grid,
                   DensityMetadata& metadata) {
    if (output.write.half && output.memoryLimit == 0) {
        // What is stated has to hold for what is in the file.
        metadata.storageError = std::max(metadata.storageError, roundToHalf(*grid));
        metadata.gridVolume = densityIntegral(*grid);
    }
    setDensityMetadata(*grid, metadata);
    if (const auto iso = isoFor(run, output.iso, grid)) {
        metadata.iso = *iso;
        setDensityMetadata(*grid, metadata);
    }
}

std::string exactErrorInWords(const SolidOutput& output, const DensityMetadata& metadata) {
    std::string words = formatNumber(metadata.closureError, 2) + " measured by closure, tolerance ";
    words += formatNumber(metadata.tolerance, 2);
    words += storageErrorInWords(output, metadata);
    return words;
}

std::string storageErrorInWords(const SolidOutput& output, const DensityMetadata& metadata) {
    if (!output.write.half) return "";
    return "; 16 bits change it by up to " + formatNumber(metadata.storageError, 2);
}

void writeSolid(ConvertJob& job, std::optional<AtomicFile>& file, const SolidOutput& output,
                const DensityOptions& density, const openvdb::FloatGrid::Ptr& grid,
                const openvdb::Vec3SGrid::Ptr& colors) {
    if (output.mesh) return writeMeshOutput(job, *file, *output.mesh, grid, colors);
    const auto made = makeOutput(job.run(), output.kind, grid);
    if (output.array) return output.array->write(job.run(), *made);
    openvdb::GridCPtrVec written{made};
    if (output.levels > 0) addLevels(job.run(), output, density, grid, written);
    if (colors) written.push_back(colors);
    if (colors && output.levels > 0) {
        for (const auto& level :
             makeDetailLevels(openvdb::Vec3SGrid::ConstPtr(colors), output.levels,
                              levelOptions(density), job.run().progress())) {
            written.push_back(level);
        }
    }
    job.writeVolume(*file, written, output.write);
}

}  // namespace bandvox::app
