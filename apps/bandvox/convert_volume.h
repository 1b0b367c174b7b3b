#pragma once

#include "command_line.h"
#include "convert_job.h"
#include "option_table.h"

#include <vector>

namespace bandvox::app {

/// The options of `convert` that are about volumes as inputs, and levels of detail.
std::vector<OptionEntry> latticeEntries();

/// How many coarser levels of detail are asked for.
int readDetailLevels(const CommandLine& line);

/// Runs `convert` for a .vdb file or an array: copies its grids, or brings them to another lattice.
void convertVolume(ConvertJob& job);

}  // namespace bandvox::app
