#pragma once

#include "command_line.h"
#include "command_run.h"
#include "iso_option.h"
#include "option_table.h"
#include "solid_density.h"

#include <bandvox/outline/volumes_to_outline.h>
#include <bandvox/source/bezier_patch.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

// What `outline` draws.
namespace bandvox::app {

/// Options about volumes, and about meshes that are made volumes.
std::vector<OptionEntry> outlineInputEntries();

/// How one input is drawn.
enum class OutlineInputKind { Patches, Volume, Solid };

/// The inputs of a command line.
struct OutlineInputs {
    std::vector<std::pair<std::string, OutlineInputKind>> files;
    std::optional<std::string> grid;
    IsoOption iso;
    DensityOptions density;  ///< of meshes and built-in shapes

    bool has(OutlineInputKind kind) const;
};

/// Throws Error(ErrorKind::Usage) for values out of range, and for options that none of the inputs
/// has a use for, Error(ErrorKind::Input) for an input that cannot be drawn.
OutlineInputs readOutlineInputs(const CommandLine& line);

/// What is drawn together.
struct OutlineScene {
    PatchModel patches;
    std::vector<OutlineVolume> volumes;
};

/// Reads all inputs; makes volumes of meshes and built-in shapes. Says what was found and done.
OutlineScene loadOutlineScene(CommandRun& run, const OutlineInputs& inputs);

}  // namespace bandvox::app
