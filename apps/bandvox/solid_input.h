#pragma once

#include "command_run.h"
#include "option_table.h"

#include <bandvox/source/mesh_source.h>

#include <memory>
#include <string>

namespace bandvox::app {

/// The argument of a command that takes a mesh or a built-in shape.
PositionalEntry solidInputEntry();

/// Throws Error(ErrorKind::Input), which says that one cannot `verb` it, unless `input` is named
/// like a mesh file or a built-in shape.
void requireMeshOrShape(const std::string& verb, const std::string& input);

/// A mesh made the boundary of a solid.
struct SolidMesh {
    std::unique_ptr<MeshSource> source;
    int holesCapped = 0;
};

/// What becomes of shells that overlap.
enum class Overlap { Union, Sum };

/// Reads a mesh and makes it the boundary of a solid; says and counts what was found and done.
SolidMesh loadSolidMesh(CommandRun& run, const std::string& input, Overlap overlap);

}  // namespace bandvox::app
