#pragma once

#include "command_run.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/source/read_mesh.h>

#include <string>

namespace bandvox::app {

/// Reads a mesh with its colours; says and counts what they are. Throws Error(ErrorKind::Input),
/// also if there are none.
ColoredMesh loadColors(CommandRun& run, const std::string& input, MeshFile& plain);

/// The grid of a mesh's colours on the lattice of its density; says and counts what came of it.
openvdb::Vec3SGrid::Ptr makeColorGrid(CommandRun& run, const ColoredMesh& mesh,
                                      const DensityResult& density, const DensityOptions& options);

}  // namespace bandvox::app
