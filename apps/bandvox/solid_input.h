#pragma once

#include "command_run.h"
#include "option_table.h"

#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh.h>
#include <bandvox/source/patch_solid.h>
#include <bandvox/source/read_mesh.h>

#include <string>

namespace bandvox::app {

/// The argument of a command that takes a mesh or a built-in shape.
PositionalEntry solidInputEntry();

/// Throws Error(ErrorKind::Input), which says that one cannot `verb` it, unless `input` is named
/// like a mesh file or a built-in shape.
void requireMeshOrShape(const std::string& verb, const std::string& input);

/// A mesh made the boundary of a solid, and what of it could not be.
struct SolidMesh {
    std::string name;
    Mesh solid;  ///< closed, and united if asked for; empty if all is soup
    Mesh soup;   ///< what only a winding number makes a solid of; empty for most
    int holesCapped = 0;
};

/// What becomes of shells that overlap.
enum class Overlap { Union, Sum };

/// How a mesh is made a solid.
struct SolidMeshOptions {
    Capping capping = Capping::Sensible;
    Overlap overlap = Overlap::Union;
};

/// Reads a mesh and makes it the boundary of a solid; says and counts what was found and done.
SolidMesh loadSolidMesh(CommandRun& run, const std::string& input, const SolidMeshOptions& options);

/// Reads free-form surfaces and makes them the boundary of a solid; says and counts what was found
/// and done.
PatchSolid loadPatchSolid(CommandRun& run, const std::string& input,
                          const PatchSolidOptions& options);

/// The same of a file that has been read.
SolidMesh makeSolidMesh(CommandRun& run, const std::string& input, MeshFile file,
                        const SolidMeshOptions& options);

}  // namespace bandvox::app
