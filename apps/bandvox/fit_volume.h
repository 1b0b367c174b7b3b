#pragma once

#include "command_line.h"
#include "option_table.h"

#include <vector>

// `bandvox fit --volume`: values at scattered places in space as grids.
namespace bandvox::app {

/// The options of `fit` that are about volumes.
std::vector<OptionEntry> fitVolumeEntries();

/// Runs `fit` for places in space.
void runFitVolume(const CommandLine& line);

}  // namespace bandvox::app
