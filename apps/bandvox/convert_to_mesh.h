#pragma once

#include "command_line.h"
#include "convert_job.h"

namespace bandvox::app {

/// True if `bandvox convert` was given a .vdb file, to make a mesh of.
bool convertsGridToMesh(const CommandLine& line);

/// Runs such a command.
void convertGridToMesh(ConvertJob& job);

}  // namespace bandvox::app
