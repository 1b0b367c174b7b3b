// bandvox convert for a mesh or a built-in shape: to a band-limited density in a .vdb file, or to
// the surface of that as a mesh.

#include "convert_solid.h"

#include "color_grid.h"
#include "command_run.h"
#include "convert_to_array.h"
#include "convert_volume.h"
#include "mesh_output.h"
#include "solid_input.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/resample/detail_levels.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::app {
namespace {

constexpr int kLargestTile = 512;
constexpr int kMostOversample = 64;

// How far the integral of a sampled shape may be from its volume, relative, before it is worth a
// word. Samples on faces, which count as inside, come to that at a few tens of voxels.
constexpr double kSampledVolumeError = 0.02;

/// By which a solid becomes a density, in the order in which --route names them.
enum class Route { Auto, Exact, Sampled, Winding };

struct ConvertRequest {
    std::string input;
    std::filesystem::path output;
    Route route = Route::Auto;
    Overlap overlap = Overlap::Union;
    DensityOptions density;
    bool color = false;
    int levels = 0;  ///< coarser ones beside the density
    std::optional<int> oversample;
    std::optional<double> samplingTolerance;  ///< if it was asked for
    VdbWriteOptions write;
    std::optional<MeshOutput> mesh;      ///< instead of the density
    std::unique_ptr<ArrayOutput> array;  ///< the same
};

void readRoute(const CommandLine& line, ConvertRequest& request) {
    request.route =
        static_cast<Route>(line.choice("route", {"auto", "exact", "sampled", "winding"}, 0));
    if (request.route == Route::Sampled && !isShape(request.input)) {
        throw Error(ErrorKind::Usage,
                    "--route sampled takes a built-in shape, by its formula, and '" +
                        request.input +
                        "' is none; a mesh takes the exact route, or that of its winding number");
    }
    if (request.route == Route::Winding && isShape(request.input)) {
        throw Error(ErrorKind::Usage, "--route winding takes a mesh, and '" + request.input +
                                          "' is a built-in shape; expected --route exact or "
                                          "sampled with it");
    }
    const bool isSampling = request.route == Route::Sampled || request.route == Route::Winding;
    if (line.has("oversample")) {
        // What of a mesh goes by its winding number is not known yet.
        const bool mayBeUsed = request.route == Route::Auto && !isShape(request.input);
        if (!isSampling && !mayBeUsed) {
            throw Error(ErrorKind::Usage,
                        "--oversample has no meaning on the exact route; expected "
                        "--route sampled with a shape, or another --route with a mesh");
        }
        request.oversample = line.wholeNumber("oversample", 1, kMostOversample, 1);
    }
    // Sampling is by far the largest error, so what is allowed is allowed to it.
    DensityOptions& density = request.density;
    if (!line.has("tolerance")) return;
    const double tolerance =
        line.number("tolerance", {.low = 1e-6, .high = 0.05}, density.tolerance);
    request.samplingTolerance = tolerance;
    density.tolerance = isSampling ? std::min(density.tolerance, tolerance) : tolerance;
}

ConvertRequest parseConvert(const CommandLine& line) {
    ConvertRequest request;
    request.input = line.positional(0);
    const std::string output = line.requiredText("output");
    request.array = ArrayOutput::read(line);
    if (!request.array) request.mesh = readVdbOrMeshOutput(line);
    readStackRequest(line, request.input);  // refuses
    request.output = outputPath(output);

    for (const char* name : {"grid", "background", "factor", "onto", "no-filter"}) {
        if (!line.has(name)) continue;
        throw Error(ErrorKind::Usage, std::string("option --") + name + " is for volumes, and '" +
                                          request.input + "' is none");
    }
    readRoute(line, request);
    DensityOptions& density = request.density;
    readSize(line, density.resolution, density.voxelSize);
    density.filter = readFilter(line, density.filter);
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

    request.color = line.has("color");
    if (request.color && isShape(request.input)) {
        throw Error(ErrorKind::Usage, "--color takes a mesh with colours, and '" + request.input +
                                          "' is a built-in shape, which has none");
    }
    request.levels = readDetailLevels(line);
    request.write.half = line.has("half");
    if (!request.array) request.write.compression = readCompression(line);
    return request;
}

bool isExact(const DensityResult& result) {
    return result.metadata.route == "exact";
}

// The sampling error that goes without a warning.
double samplingTolerance(const ConvertRequest& request, const DensityResult& result) {
    const bool isSampled = result.metadata.route == "sampled";
    return request.samplingTolerance.value_or(isSampled ? FieldDensityOptions().samplingTolerance
                                                        : SoupDensityOptions().samplingTolerance);
}

std::string errorInWords(const ConvertRequest& request, const DensityResult& result) {
    const DensityMetadata& metadata = result.metadata;
    std::string words;
    if (isExact(result)) {
        words = formatNumber(metadata.closureError, 2) + " measured by closure, tolerance " +
                formatNumber(metadata.tolerance, 2);
    } else if (std::isnan(metadata.samplingError)) {
        words = "not known, since an odd number of samples cannot be halved";
    } else {
        words = formatNumber(metadata.samplingError, 2) +
                (metadata.route == "sampled" ? " measured by halving the samples, tolerance "
                                             : " measured with every fourth row, tolerance ") +
                formatNumber(samplingTolerance(request, result), 2);
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
        (result.fieldSamples > 0
             ? ", from " + formatCount(result.fieldSamples, "sample", "samples")
             : ", spread over " + std::to_string(result.kernelWidth) + " voxels from " +
                   formatCount(result.surfaceSamples, "surface sample", "surface samples")));
    run.say("error    " + errorInWords(request, result));
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

/// What goes into the file.
struct ConvertedGrids {
    DensityResult density;
    std::optional<ColorResult> color;  ///< if it was asked for
};

DensityResult meshToDensity(CommandRun& run, const ConvertRequest& request, MeshFile file) {
    const Capping capping = request.route == Route::Exact     ? Capping::All
                            : request.route == Route::Winding ? Capping::None
                                                              : Capping::Sensible;
    SolidMesh mesh = makeSolidMesh(run, request.input, std::move(file), {capping, request.overlap});
    DensityResult result;
    if (mesh.soup.triangles.empty()) {
        const MeshSource source(mesh.name, std::move(mesh.solid));
        result = surfaceToDensity(source, request.density, run.progress());
        if (request.oversample) {
            result.warnings.push_back(
                "--oversample was not used: caps close the whole mesh, which took the exact route");
        }
    } else {
        SoupDensityOptions options;
        options.density = request.density;
        options.density.tolerance = std::min(options.density.tolerance, DensityOptions().tolerance);
        options.rowsPerVoxel = request.oversample.value_or(options.rowsPerVoxel);
        options.samplingTolerance = request.samplingTolerance.value_or(options.samplingTolerance);
        result = soupToDensity({mesh.name, std::move(mesh.soup), std::move(mesh.solid)}, options,
                               run.progress());
    }
    result.metadata.holesCapped = mesh.holesCapped;
    return result;
}

ConvertedGrids meshToGrids(CommandRun& run, const ConvertRequest& request) {
    if (!request.color) {
        return {meshToDensity(run, request, readMesh(request.input, run.progress())), {}};
    }
    // Colours are those of the triangles as read, whatever is done to make a solid of them.
    MeshFile plain;
    const ColoredMesh colored = loadColors(run, request.input, plain);
    DensityResult density = meshToDensity(run, request, std::move(plain));
    ColorResult color = makeColors(run, colored, density, request.density);
    return {std::move(density), std::move(color)};
}

DensityResult shapeToDensity(CommandRun& run, const ConvertRequest& request) {
    run.say("read     " + request.input);
    const auto boundary = makeShapeBoundary(request.input);
    if (request.route != Route::Sampled) {
        return surfaceToDensity(*boundary, request.density, run.progress());
    }
    FieldDensityOptions options;
    options.density = request.density;
    options.oversample = request.oversample.value_or(options.oversample);
    options.samplingTolerance = request.samplingTolerance.value_or(options.samplingTolerance);
    DensityResult result = fieldToDensity(*makeShapeField(request.input), options, run.progress());
    // Of a shape, unlike other fields, the volume is known.
    DensityMetadata& metadata = result.metadata;
    metadata.sourceVolume = boundary->volume();
    const double difference = std::abs(metadata.gridVolume / metadata.sourceVolume - 1);
    // Where the sampling error is too large, that has been said.
    if (difference > kSampledVolumeError && !metadata.clamped && result.warnings.empty()) {
        result.warnings.push_back("the integral of the density differs from the volume by " +
                                  formatNumber(100 * difference, 2) +
                                  " %; use more voxels, or take more samples (--oversample)");
    }
    return result;
}

// The default tolerance of sampling warns; one that was asked for has to be kept.
void requireTolerance(const ConvertRequest& request, const DensityResult& result) {
    if (isExact(result) || !request.samplingTolerance) return;
    const double asked = *request.samplingTolerance;
    const double error = result.metadata.samplingError;
    if (std::isnan(error)) {
        throw Error(ErrorKind::Result,
                    "the sampling error is not known for an odd --oversample, so it cannot be told "
                    "to keep to the tolerance asked for, " +
                        formatNumber(asked, 2) + "; expected an even one");
    }
    if (error <= asked) return;
    const bool isSampled = request.route == Route::Sampled;
    throw Error(ErrorKind::Result, "the sampling error of " + formatNumber(error, 2) +
                                       " is above the tolerance asked for, " +
                                       formatNumber(asked, 2) + "; take more samples (" +
                                       (isSampled ? "--oversample), or the exact route"
                                                  : "--oversample), or a mesh that is closed"));
}

std::vector<openvdb::FloatGrid::Ptr> makeLevels(CommandRun& run, const ConvertRequest& request,
                                                const openvdb::FloatGrid::Ptr& grid) {
    ResampleOptions options;
    options.filter = request.density.filter;
    options.tolerance = std::max(request.density.tolerance, options.tolerance);
    auto levels = makeDetailLevels(grid, request.levels, options, run.progress());
    for (const auto& level : levels) {
        if (request.write.half) roundToHalf(*level);
        run.say("level    " + level->getName() + ": " +
                formatCount(static_cast<std::int64_t>(level->activeVoxelCount()), "active voxel",
                            "active voxels") +
                " of side " + formatNumber(level->voxelSize().x()));
    }
    return levels;
}

}  // namespace

void convertSolid(const CommandLine& line) {
    const ConvertRequest request = parseConvert(line);
    requireMeshOrShape("convert", request.input);
    CommandRun run(line);
    std::optional<AtomicFile> output;
    if (!request.array) output.emplace(request.output);

    ConvertedGrids grids = isShape(request.input) ? ConvertedGrids{shapeToDensity(run, request), {}}
                                                  : meshToGrids(run, request);
    DensityResult& result = grids.density;
    requireTolerance(request, result);
    if (request.write.half) {
        // What is stated has to hold for what is in the file.
        result.metadata.storageError = roundToHalf(*result.grid);
        result.metadata.gridVolume = densityIntegral(*result.grid);
    }
    setDensityMetadata(*result.grid, result.metadata);
    sayResult(run, request, result);
    if (grids.color) sayColors(run, *grids.color);
    run.warn(result.warnings, ErrorKind::Result);

    if (request.array) return request.array->write(run, *result.grid);
    if (request.mesh) {
        const auto colors = grids.color ? grids.color->grid : nullptr;
        return writeMeshOutput(run, *output, *request.mesh, result.grid, colors);
    }
    openvdb::GridCPtrVec written{result.grid};
    if (request.levels > 0) {
        for (const auto& level : makeLevels(run, request, result.grid)) written.push_back(level);
    }
    if (grids.color) written.push_back(grids.color->grid);
    run.writeOutput(*output, [&](AtomicFile& file) { writeVdb(file, written, request.write); });
}

}  // namespace bandvox::app
