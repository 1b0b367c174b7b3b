#pragma once

#include "command_line.h"

#include <string>

// The settings that `bandvox convert` has used, as its output tells them.
//
// They are text: a line "# CONVERSION by bandvox VERSION", then a line "option=value" for each
// option that changes the result, in the order of their names. " # default" stands behind a value
// that was not asked for: where an option means more by being given (a --tolerance is then kept to,
// or nothing is written), that is not lost when the settings are used again.
namespace bandvox::app {

/// What `convert` makes of what.
enum class Conversion {
    SolidToVolume,
    SolidToMesh,
    VolumeToVolume,
    VolumeToMesh,
    GridSolidToVolume,  ///< of the solid that a volume stands for
    GridSolidToMesh,
};

/// Which one the names of input and output, --as and --threshold ask for.
Conversion conversionOf(const CommandLine& line);

/// The settings of a command line of `convert`, with defaults resolved. The lattice of --onto is
/// told by a digest. Throws what reading the file of --onto does.
std::string settingsText(const CommandLine& line);

/// What sets two texts of settings apart, in words, as "cutoff was 0.16, is 0.25"; empty if they
/// give the same result.
std::string settingsDifference(const std::string& before, const std::string& now);

/// A command line of `convert` with the settings of the file that --like names, a .vdb file or a
/// mesh, where the line does not say otherwise; those that have no meaning for its conversion are
/// left out. The line itself without --like. Throws Error(ErrorKind::Input) if that file has no
/// settings, or such as this version does not know.
CommandLine withLikedSettings(const CommandLine& line);

}  // namespace bandvox::app
