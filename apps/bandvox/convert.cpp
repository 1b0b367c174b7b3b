// bandvox convert: a mesh or a built-in shape to a band-limited density in a .vdb file.

#include "command_run.h"
#include "commands.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

namespace bandvox::app {
namespace {

constexpr int kLargestTile = 512;
constexpr int kMostOversample = 64;

// How far the integral of a sampled shape may be from its volume, relative, before it is worth a
// word. Samples on faces, which count as inside, come to that at a few tens of voxels.
constexpr double kSampledVolumeError = 0.02;

struct ConvertRequest {
    std::string input;
    std::filesystem::path output;
    bool isSampled = false;  ///< by the sampled route
    bool isToleranceAsked = false;
    Overlap overlap = Overlap::Union;
    FieldDensityOptions field;  ///< `density` of it holds for the exact route, too
    VdbWriteOptions write;
};

/// A solid, and what was done to make it one.
struct Solid {
    std::unique_ptr<BoundarySource> source;
    int holesCapped = 0;
};

void readRoute(const CommandLine& line, ConvertRequest& request) {
    request.isSampled = line.choice("route", {"auto", "exact", "sampled"}, 0) == 2;
    if (line.has("oversample") && !request.isSampled) {
        throw Error(ErrorKind::Usage,
                    "--oversample is for the sampled route; expected --route sampled with it");
    }
    if (request.isSampled && !isShape(request.input)) {
        throw Error(ErrorKind::Usage,
                    "--route sampled takes a built-in shape, by its formula, and "
                    "'" +
                        request.input +
                        "' is none; a mesh takes the exact "
                        "route");
    }
    request.field.oversample =
        line.wholeNumber("oversample", 1, kMostOversample, request.field.oversample);
    // Sampling is by far the largest error, so what is allowed is allowed to it.
    DensityOptions& density = request.field.density;
    const double tolerance =
        line.number("tolerance", {.low = 1e-6, .high = 0.05},
                    request.isSampled ? request.field.samplingTolerance : density.tolerance);
    if (request.isSampled) request.field.samplingTolerance = tolerance;
    request.isToleranceAsked = line.has("tolerance");
    density.tolerance = request.isSampled ? std::min(density.tolerance, tolerance) : tolerance;
}

ConvertRequest parseConvert(const CommandLine& line) {
    ConvertRequest request;
    request.input = line.positional(0);
    const std::string output = line.requiredText("output");
    requireExtension(output, {".vdb"});
    request.output = outputPath(output);

    readRoute(line, request);
    DensityOptions& density = request.field.density;
    readSize(line, density.resolution, density.voxelSize);
    density.filter.cutoff =
        line.number("cutoff", {.low = 0.01, .high = 0.5}, density.filter.cutoff);
    density.filter.order = line.number("order", {.low = 1, .high = 64}, density.filter.order);
    density.tile = line.wholeNumber("tile", 0, kLargestTile, density.tile);
    if (density.tile % 2 != 0) {
        throw Error(ErrorKind::Usage, "option --tile is '" + std::to_string(density.tile) +
                                          "'; expected an even number");
    }
    density.iso =
        line.number("iso", {.low = 0, .high = 1, .lowOpen = true, .highOpen = true}, density.iso);
    density.clamp = line.has("clamp");
    request.overlap = static_cast<Overlap>(line.choice("overlap", {"union", "sum"}, 0));
    density.sumOverlaps = request.overlap == Overlap::Sum;

    request.write.half = line.has("half");
    request.write.compression = readCompression(line);
    return request;
}

Solid loadSolid(CommandRun& run, const std::string& input, Overlap overlap) {
    if (!isShape(input)) {
        SolidMesh mesh = loadSolidMesh(run, input, overlap);
        return {std::move(mesh.source), mesh.holesCapped};
    }
    Solid solid{makeShapeBoundary(input), 0};
    run.say("read     " + input);
    return solid;
}

std::string errorInWords(const ConvertRequest& request, const DensityMetadata& metadata) {
    std::string words;
    if (!request.isSampled) {
        words = formatNumber(metadata.closureError, 2) + " measured by closure, tolerance " +
                formatNumber(metadata.tolerance, 2);
    } else if (std::isnan(metadata.samplingError)) {
        words = "not known, since an odd number of samples cannot be halved";
    } else {
        words = formatNumber(metadata.samplingError, 2) +
                " measured by halving the samples, tolerance " +
                formatNumber(request.field.samplingTolerance, 2);
    }
    if (request.write.half) {
        words += "; 16 bits change it by up to " + formatNumber(metadata.storageError, 2);
    }
    return words;
}

void sayResult(CommandRun& run, const ConvertRequest& request, const DensityResult& result) {
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
        (request.isSampled
             ? ", from " + formatCount(result.fieldSamples, "sample", "samples")
             : ", spread over " + std::to_string(result.kernelWidth) + " voxels from " +
                   formatCount(result.surfaceSamples, "surface sample", "surface samples")));
    run.say("error    " + errorInWords(request, metadata));
    const double difference =
        metadata.sourceVolume != 0
            ? std::abs(metadata.gridVolume - metadata.sourceVolume) / metadata.sourceVolume
            : 0;
    run.say("volume   source " + formatNumber(metadata.sourceVolume, 8) + ", grid " +
            formatNumber(metadata.gridVolume, 8) + ", relative difference " +
            formatNumber(difference, 2));

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

DensityResult toDensity(CommandRun& run, const ConvertRequest& request) {
    if (!request.isSampled) {
        const Solid solid = loadSolid(run, request.input, request.overlap);
        DensityResult result =
            surfaceToDensity(*solid.source, request.field.density, run.progress());
        result.metadata.holesCapped = solid.holesCapped;
        return result;
    }
    const auto field = makeShapeField(request.input);
    run.say("read     " + request.input);
    DensityResult result = fieldToDensity(*field, request.field, run.progress());
    // Of a shape, unlike other fields, the volume is known.
    DensityMetadata& metadata = result.metadata;
    metadata.sourceVolume = makeShapeBoundary(request.input)->volume();
    const double difference = std::abs(metadata.gridVolume / metadata.sourceVolume - 1);
    // Where the sampling error is too large, that has been said.
    if (difference > kSampledVolumeError && !metadata.clamped && result.warnings.empty()) {
        result.warnings.push_back("the integral of the density differs from the volume by " +
                                  formatNumber(100 * difference, 2) +
                                  " %; use more voxels, or take more samples (--oversample)");
    }
    return result;
}

// The default tolerance of the sampled route warns; one that was asked for has to be kept.
void requireTolerance(const ConvertRequest& request, const DensityMetadata& metadata) {
    const double asked = request.field.samplingTolerance;
    if (!request.isSampled || !request.isToleranceAsked) return;
    if (std::isnan(metadata.samplingError)) {
        throw Error(ErrorKind::Result,
                    "the sampling error is not known for an odd --oversample, so it cannot be told "
                    "to keep to the tolerance asked for, " +
                        formatNumber(asked, 2) + "; expected an even one");
    }
    if (metadata.samplingError <= asked) return;
    throw Error(ErrorKind::Result,
                "the sampling error of " + formatNumber(metadata.samplingError, 2) +
                    " is above the tolerance asked for, " + formatNumber(asked, 2) +
                    "; take more samples (--oversample), or the exact route");
}

}  // namespace

const CommandTable& convertTable() {
    static const CommandTable table = [] {
        const DensityOptions density;
        const std::string filter = "Filter";
        return CommandTable{
            "convert",
            "Turn a mesh or a built-in shape into a band-limited density (.vdb).",
            "Turns the solid inside a mesh into a density on a grid: 1 inside, 0 outside, and in "
            "between only what the grid can hold. The solid is filtered before it is sampled, so "
            "nothing aliases; the error is measured and stored in the grid. Holes of the mesh are "
            "capped, and said so.",
            {solidInputEntry()},
            {
                resolutionEntry(density.resolution),
                voxelSizeEntry(),
                {"cutoff", 0, "K", formatNumber(density.filter.cutoff),
                 "Cutoff k_c of the filter exp(-(k/k_c)^n), in cycles per voxel, 0.01 to 0.5.",
                 filter},
                {"order", 0, "N", formatNumber(density.filter.order),
                 "Order n of the filter, 1 to 64. 2 never rings; more keeps more detail and "
                 "overshoots at flat faces.",
                 filter},
                {"tolerance", 0, "E", formatNumber(density.tolerance),
                 "Error of the density that is allowed, 1e-6 to 0.05. On the sampled route its "
                 "default is " +
                     formatNumber(FieldDensityOptions().samplingTolerance) + ".",
                 filter},
                {"tile", 0, "N", "chosen",
                 "Side of the cube that is filtered at a time, in voxels, even, at most 512.",
                 filter},
                {"route", 0, "KIND", "auto",
                 "exact: from the surface itself. sampled: from samples of a shape's formula, "
                 "which alias a little. auto: exact, where there is a surface.",
                 filter},
                {"oversample", 0, "P", std::to_string(FieldDensityOptions().oversample),
                 "Samples along a voxel's side on the sampled route, 1 to 64; an even number has "
                 "its error measured.",
                 filter},
                {"overlap", 0, "KIND", "union",
                 "Where shells of a mesh overlap. union: inside is inside. sum: densities add up, "
                 "so that near parts blend into each other.",
                 filter},
                {"clamp", 0, "", "", "Limit the density to 0 .. 1, which cuts off ringing.",
                 filter},
                {"iso", 0, "D", formatNumber(density.iso),
                 "Density that is the surface, for the commands that come after.", filter},
                vdbOutputEntry(),
                {"half", 0, "", "",
                 "Store 16-bit values, which changes densities by up to 2.5e-4, above 1 by 5e-4.",
                 "Output"},
                compressionEntry(),
            },
            {
                {"bandvox convert bunny.obj -o bunny.vdb --resolution 512",
                 "512 voxels along the bunny's longest side."},
                {"bandvox convert shape:torus -o torus.vdb --order 4 --cutoff 0.25",
                 "A sharper filter, that keeps more detail and rings by 5 %."},
                {"bandvox convert part.stl -o part.vdb --voxel-size 0.1 --strict",
                 "Voxels of a given size, and no result if anything about the mesh is doubtful."},
            }};
    }();
    return table;
}

void runConvert(const CommandLine& line) {
    const ConvertRequest request = parseConvert(line);
    requireMeshOrShape("convert", request.input);
    CommandRun run(line);
    AtomicFile output(request.output);

    DensityResult result = toDensity(run, request);
    requireTolerance(request, result.metadata);
    if (request.write.half) {
        // What is stated has to hold for what is in the file.
        result.metadata.storageError = roundToHalf(*result.grid);
        result.metadata.gridVolume = densityIntegral(*result.grid);
    }
    setDensityMetadata(*result.grid, result.metadata);
    sayResult(run, request, result);
    run.warn(result.warnings, ErrorKind::Result);

    run.writeOutput(output,
                    [&](AtomicFile& file) { writeVdb(file, {result.grid}, request.write); });
}

}  // namespace bandvox::app
