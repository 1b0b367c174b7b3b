#pragma once

#include "command_line.h"
#include "command_run.h"
#include "option_table.h"
#include "solid_density.h"

#include <bandvox/outline/volumes_to_outline.h>
#include <bandvox/source/bezier_patch.h>

#include <optional>
#include <string>
#include <vector>

// What `outline` draws.
namespace bandvox::app {

/// Options about volumes, and about meshes that are made volumes.
std::vector<OptionEntry> outlineInputEntries();

/// The inputs of a command line.
struct OutlineInputs {
    std::vector<std::string> files;
    std::optional<std::string> grid;
    std::optional<double> iso;
    DensityOptions density;  ///< of meshes
};

/// Throws Error(ErrorKind::Usage) for values out of range, and for options that none of the inputs
/// has a use for.
OutlineInputs readOutlineInputs(const CommandLine& line);

/// What is drawn together.
struct OutlineScene {
    PatchModel patches;
    std::vector<OutlineVolume> volumes;
};

/// Reads all inputs; makes volumes of meshes and built-in shapes. Says what was found and done.
OutlineScene loadOutlineScene(CommandRun& run, const OutlineInputs& inputs);

}  // namespace bandvox::app
