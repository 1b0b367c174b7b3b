#pragma once

#include "command_run.h"

#include <bandvox/scatter/fit_residual.h>
#include <bandvox/scatter/read_scattered_points.h>

#include <cstddef>
#include <string>

// What `bandvox fit` says of surfaces and of volumes alike.
namespace bandvox::app {

void sayPoints(CommandRun& run, const std::string& input, const ScatteredPoints& points);

/// Says and counts how many points there are, and how many were in the place of another.
void sayDuplicates(CommandRun& run, std::size_t points, std::size_t duplicates);

/// What the user asked for has to be there; what holds otherwise is worth a warning. Throws
/// Error(ErrorKind::Result).
void judgeResidual(CommandRun& run, const FitResidual& residual);

}  // namespace bandvox::app
