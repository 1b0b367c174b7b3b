#pragma once

#include "command_line.h"
#include "command_run.h"
#include "option_table.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/atomic_file.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/scatter/bspline_surface.h>
#include <bandvox/scatter/surface_quantity.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// What `bandvox fit` writes.
namespace bandvox::app {

/// The options of `fit` that are about its output.
std::vector<OptionEntry> fitOutputEntries();

struct FitOutput {
    enum class Kind { Patches, Mesh, Picture, Samples, Density };
    std::filesystem::path path;
    Kind kind = Kind::Patches;
    int samples = 0;                          ///< along the longer side
    std::vector<SurfaceQuantity> quantities;  ///< of an array, or a picture's own channels
    std::optional<double> base;               ///< of the solid, world units
    DensityOptions density;
    VdbWriteOptions write;
};

/// Throws Error(ErrorKind::Usage) for options out of range, and such as have no meaning with the
/// kind of output.
FitOutput readFitOutput(const CommandLine& line);

/// A surface, and what is known of it.
struct FittedSurface {
    const BsplineSurface& surface;
    const std::vector<std::string>& names;  ///< of its columns
    std::string input;
};

/// Writes the surface, the last step of the command, with the colours that redColumn finds.
void writeFit(CommandRun& run, AtomicFile& output, const FitOutput& request,
              const FittedSurface& fitted);

}  // namespace bandvox::app
