#pragma once

#include "command_run.h"
#include "solid_input.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_vdb.h>
#include <bandvox/source/mesh.h>

#include <cstdint>
#include <optional>
#include <string>

namespace bandvox::app {

/// By which a solid becomes a density, in the order in which --route names them.
enum class Route { Auto, Exact, Sampled, Winding };

/// A mesh, a built-in shape or free-form surfaces, and how they become a density.
struct SolidDensityRequest {
    std::string input;
    bool isPatches = false;      ///< free-form surfaces
    std::optional<double> base;  ///< of those
    Route route = Route::Auto;
    Overlap overlap = Overlap::Union;
    DensityOptions density;
    bool oversampleGiven = false;
    int samplesPerSide = FieldDensityOptions().oversample;  ///< of the sampled route
    int rowsPerVoxel = SoupDensityOptions().rowsPerVoxel;   ///< of that of the winding number
    std::optional<double> samplingTolerance;                ///< if it was asked for
    VdbTarget target;             ///< of a limit of memory; without one there is none
    std::int64_t peakBefore = 0;  ///< bytes that the process had held before the input was read
};

/// Makes a density of a mesh that was read from the input; says what was found and done.
DensityResult meshToDensity(CommandRun& run, const SolidDensityRequest& request, MeshFile file);

/// Makes a density of the input; says what was found and done.
DensityResult solidToDensity(CommandRun& run, const SolidDensityRequest& request);

}  // namespace bandvox::app
