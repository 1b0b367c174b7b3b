#pragma once

#include "command_line.h"

namespace bandvox::app {

/// True if `bandvox convert` was given a .vdb file, to make a mesh of.
bool convertsGridToMesh(const CommandLine& line);

/// Runs such a command.
void convertGridToMesh(const CommandLine& line);

}  // namespace bandvox::app
