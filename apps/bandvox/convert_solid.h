#pragma once

#include "command_line.h"

namespace bandvox::app {

/// Runs `convert` for a mesh or a built-in shape.
void convertSolid(const CommandLine& line);

}  // namespace bandvox::app
