#pragma once

#include "command_line.h"
#include "command_run.h"
#include "option_table.h"

#include <openvdb/openvdb.h>

#include <optional>
#include <vector>

namespace bandvox::app {

/// What a solid is written as.
struct OutputKind {
    enum class Kind { Density, LevelSet, Fog } kind = Kind::Density;
    double halfWidth = 3;  ///< of a level set's or fog's band, voxels
};

/// The options --as and --band.
std::vector<OptionEntry> outputKindEntries();

/// True if --as asks for the values of a volume as they are.
bool asksForValues(const CommandLine& line);

/// What --as asks for; nothing without it, or for values. Throws Error(ErrorKind::Usage) for
/// options that have no meaning with it.
std::optional<OutputKind> readOutputKind(const CommandLine& line);

/// What is written for a density, or for a grid whose surface is {f = iso}. A density stays as it
/// is.
openvdb::FloatGrid::Ptr makeOutput(CommandRun& run, const OutputKind& kind,
                                   const openvdb::FloatGrid::Ptr& grid,
                                   const std::optional<double>& iso = {});

}  // namespace bandvox::app
