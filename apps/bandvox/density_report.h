#pragma once

#include "command_run.h"

#include <bandvox/bandlimit/density.h>

#include <string>

namespace bandvox::app {

/// Says and counts what came of a solid. `error`: in words, how far the density may be off.
void sayDensity(CommandRun& run, const DensityResult& result, const std::string& error);

}  // namespace bandvox::app
