#pragma once

#include "convert_job.h"

namespace bandvox::app {

/// Runs `convert` for a mesh or a built-in shape.
void convertSolid(ConvertJob& job);

}  // namespace bandvox::app
