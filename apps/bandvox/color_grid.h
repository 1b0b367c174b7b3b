#pragma once

#include "command_run.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/bandlimit/surface_to_color.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/source/read_mesh.h>

#include <string>

namespace bandvox::app {

/// Reads a mesh with its colours; says and counts what they are. Throws Error(ErrorKind::Input),
/// also if there are none.
ColoredMesh loadColors(CommandRun& run, const std::string& input, MeshFile& plain);

/// The colours of a mesh on the lattice of its density.
ColorResult makeColors(CommandRun& run, const ColoredMesh& mesh, const DensityResult& density,
                       const DensityOptions& options);

/// Says and counts what came of it.
void sayColors(CommandRun& run, const ColorResult& result);

}  // namespace bandvox::app
