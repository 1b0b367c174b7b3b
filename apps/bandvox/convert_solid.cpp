// bandvox convert for a mesh or a built-in shape: to a band-limited density in a .vdb file, or to
// the surface of that as a mesh.

#include "convert_solid.h"

#include "color_grid.h"
#include "command_run.h"
#include "density_report.h"
#include "solid_density.h"
#include "solid_input.h"
#include "solid_output.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/core/memory.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/read_patches.h>
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

constexpr int kMostOversample = 64;

struct ConvertRequest : SolidDensityRequest {
    bool color = false;
    SolidOutput output;
};

void readRoute(const CommandLine& line, ConvertRequest& request) {
    request.route = static_cast<Route>(line.choice("route", 0));
    const bool isExactRoute = request.route == Route::Auto || request.route == Route::Exact;
    if (request.isPatches && !isExactRoute) {
        throw Error(ErrorKind::Usage,
                    "--route sampled and winding are not for free-form surfaces, "
                    "as '" +
                        request.input + "' has them; expected --route exact");
    }
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
        const bool mayBeUsed =
            request.route == Route::Auto && !isShape(request.input) && !request.isPatches;
        if (!isSampling && !mayBeUsed) {
            throw Error(ErrorKind::Usage,
                        "--oversample has no meaning on the exact route; expected "
                        "--route sampled with a shape, or another --route with a mesh");
        }
        request.oversampleGiven = true;
    }
    request.samplesPerSide =
        line.wholeNumber("oversample", 1, kMostOversample, request.samplesPerSide);
    request.rowsPerVoxel = line.wholeNumber("oversample", 1, kMostOversample, request.rowsPerVoxel);
    // Sampling is by far the largest error, so what is allowed is allowed to it.
    DensityOptions& density = request.density;
    const double tolerance =
        line.number("tolerance", {.low = 1e-6, .high = 0.05}, density.tolerance);
    if (line.has("tolerance")) request.samplingTolerance = tolerance;
    density.tolerance = isSampling ? std::min(density.tolerance, tolerance) : tolerance;
}

ConvertRequest parseConvert(const CommandLine& line) {
    ConvertRequest request;
    request.input = line.positional(0);
    request.output = readSolidOutput(line, "a solid");
    readStackRequest(line, request.input);  // refuses
    for (const char* name : {"grid", "background", "factor", "onto", "no-filter", "threshold"}) {
        if (!line.has(name)) continue;
        throw Error(ErrorKind::Usage, std::string("option --") + name + " is for volumes, and '" +
                                          request.input + "' is none");
    }
    refuseOptions(line, {"points", "radius"}, "with a mesh or a shape");
    request.isPatches = isPatchFile(request.input);
    readRoute(line, request);
    if (line.has("base")) {
        if (!request.isPatches) {
            throw Error(ErrorKind::Usage, "--base is for free-form surfaces (.bpt, .obj), and '" +
                                              request.input + "' has none");
        }
        request.base = line.number("base", {}, 0);
    }
    DensityOptions& density = request.density;
    readSize(line, density.resolution, density.voxelSize);
    readDensityOptions(line, request.output, density);
    request.overlap = static_cast<Overlap>(line.choice("overlap", 0));
    density.sumOverlaps = request.overlap == Overlap::Sum;

    request.target = {request.output.path, request.output.write, request.output.memoryLimit};
    request.peakBefore = peakMemory();

    request.color = line.has("color");
    if (request.color && request.isPatches) {
        throw Error(ErrorKind::Usage, "--color takes a mesh with colours, and '" + request.input +
                                          "' has free-form surfaces, which have none");
    }
    if (request.color && isShape(request.input)) {
        throw Error(ErrorKind::Usage, "--color takes a mesh with colours, and '" + request.input +
                                          "' is a built-in shape, which has none");
    }
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
    if (isExact(result)) return exactErrorInWords(request.output, metadata);
    if (std::isnan(metadata.samplingError)) {
        words = "not known, since an odd number of samples cannot be halved";
    } else {
        words = formatNumber(metadata.samplingError, 2) +
                (metadata.route == "sampled" ? " measured by halving the samples, tolerance "
                                             : " measured with every fourth row, tolerance ") +
                formatNumber(samplingTolerance(request, result), 2);
    }
    return words + storageErrorInWords(request.output, metadata);
}

/// What goes into the file.
struct ConvertedGrids {
    DensityResult density;
    std::optional<ColorResult> color;  ///< if it was asked for
};

ConvertedGrids solidToGrids(CommandRun& run, const ConvertRequest& request) {
    if (!request.color) return {solidToDensity(run, request), {}};
    // Colours are those of the triangles as read, whatever is done to make a solid of them.
    MeshFile plain;
    const ColoredMesh colored = loadColors(run, request.input, plain);
    DensityResult density = meshToDensity(run, request, std::move(plain));
    ColorResult color = makeColors(run, colored, density, request.density);
    return {std::move(density), std::move(color)};
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

}  // namespace

void convertSolid(ConvertJob& job) {
    const ConvertRequest request = parseConvert(job.line());
    if (!request.isPatches) requireMeshOrShape("convert", request.input);
    if (!job.begin()) return;
    CommandRun& run = job.run();
    std::optional<AtomicFile> file = request.output.openFile();
    if (request.output.memoryLimit > 0 && file->inPlace()) {
        throw Error(ErrorKind::Usage, "--memory-limit is for files: '" +
                                          request.output.path.string() +
                                          "' is a pipe or a device, which has no room beside it");
    }
    ConvertedGrids grids = solidToGrids(run, request);
    DensityResult& result = grids.density;
    requireTolerance(request, result);
    finishDensity(run, request.output, result.grid, result.metadata);
    sayDensity(run, result, errorInWords(request, result));
    if (grids.color) sayColors(run, *grids.color);
    run.warn(result.warnings, ErrorKind::Result);
    writeSolid(job, file, request.output, request.density, result.grid,
               grids.color ? grids.color->grid : nullptr);
}

}  // namespace bandvox::app
