#include "solid_density.h"

#include "memory_limit.h"
#include "words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/shapes.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox::app {
namespace {

// How far the integral of a sampled shape may be from its volume, relative, before it is worth a
// word. Samples on faces, which count as inside, come to that at a few tens of voxels.
constexpr double kSampledVolumeError = 0.02;

DensityResult exactDensity(CommandRun& run, const SolidDensityRequest& request,
                           const BoundarySource& source) {
    if (request.target.memoryLimit == 0) {
        return surfaceToDensity(source, request.density, run.progress());
    }
    requireReadWithin(request.target.memoryLimit, request.peakBefore);
    return surfaceToSpooledDensity(source, request.density, request.target, run.progress());
}

DensityResult patchesToDensity(CommandRun& run, const SolidDensityRequest& request) {
    const PatchSolid solid = loadPatchSolid(
        run, request.input, {.unite = request.overlap == Overlap::Union, .base = request.base});
    DensityResult result = exactDensity(run, request, *solid.source);
    result.metadata.holesCapped = static_cast<int>(solid.report.holes.size());
    return result;
}

DensityResult shapeToDensity(CommandRun& run, const SolidDensityRequest& request) {
    run.say("read     " + request.input);
    const auto boundary = makeShapeBoundary(request.input);
    if (request.route != Route::Sampled) {
        return exactDensity(run, request, *boundary);
    }
    FieldDensityOptions options;
    options.density = request.density;
    options.oversample = request.samplesPerSide;
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

}  // namespace

DensityResult meshToDensity(CommandRun& run, const SolidDensityRequest& request, MeshFile file) {
    const Capping capping = request.route == Route::Exact     ? Capping::All
                            : request.route == Route::Winding ? Capping::None
                                                              : Capping::Sensible;
    SolidMesh mesh = makeSolidMesh(run, request.input, std::move(file), {capping, request.overlap});
    DensityResult result;
    if (mesh.soup.triangles.empty()) {
        const MeshSource source(mesh.name, std::move(mesh.solid));
        result = exactDensity(run, request, source);
        if (request.oversampleGiven) {
            result.warnings.push_back(
                "--oversample was not used: caps close the whole mesh, which took the exact route");
        }
    } else {
        if (request.target.memoryLimit > 0) {
            throw Error(ErrorKind::Usage,
                        "--memory-limit is for meshes that caps can close: of '" + request.input +
                            "' some goes by its winding number, which needs the whole grid in "
                            "memory; expected --route exact, which caps every hole, or no limit");
        }
        SoupDensityOptions options;
        options.density = request.density;
        options.density.tolerance = std::min(options.density.tolerance, DensityOptions().tolerance);
        options.rowsPerVoxel = request.rowsPerVoxel;
        options.samplingTolerance = request.samplingTolerance.value_or(options.samplingTolerance);
        result = soupToDensity({mesh.name, std::move(mesh.soup), std::move(mesh.solid)}, options,
                               run.progress());
    }
    result.metadata.holesCapped = mesh.holesCapped;
    return result;
}

DensityResult solidToDensity(CommandRun& run, const SolidDensityRequest& request) {
    if (isShape(request.input)) return shapeToDensity(run, request);
    if (request.isPatches) return patchesToDensity(run, request);
    return meshToDensity(run, request, readMesh(request.input, run.progress()));
}

}  // namespace bandvox::app
