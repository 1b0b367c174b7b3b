#pragma once

#include "command_line.h"
#include "progress_estimate.h"

#include <vector>

namespace bandvox::app {

/// The stages that a command is expected to go through, with the shares of the time that they
/// take of an ordinary input. They need not be right: they decide how evenly a percentage grows.
std::vector<ExpectedStage> expectedStages(const CommandLine& line);

}  // namespace bandvox::app
