#pragma once

#include "command_line.h"
#include "convert_job.h"
#include "option_table.h"

#include <vector>

namespace bandvox::app {

/// The options of `convert` that are about points.
std::vector<OptionEntry> pointEntries();

/// True if the input of `convert` is a file of points.
bool takesPoints(const CommandLine& line);

/// Runs `convert` for points: the union of balls, or the solid whose surface they are on.
void convertPoints(ConvertJob& job);

}  // namespace bandvox::app
