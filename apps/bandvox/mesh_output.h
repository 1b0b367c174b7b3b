#pragma once

#include "command_line.h"
#include "convert_job.h"
#include "option_table.h"

#include <openvdb/openvdb.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// The surface of a density as a mesh file.
namespace bandvox::app {

/// The option --output of a command that writes a density or a mesh.
OptionEntry meshOrVdbOutputEntry();

/// The option --adaptivity.
OptionEntry adaptivityEntry();

/// Throws Error(ErrorKind::Usage) if one of `options` was given, which has no meaning `where`.
void refuseOptions(const CommandLine& line, const std::vector<std::string>& options,
                   const std::string& where);

/// How a mesh is written.
struct MeshOutput {
    std::filesystem::path path;
    double adaptivity = 0;
    std::optional<double> iso;  ///< default: that of the grid
};

/// Throws Error(ErrorKind::Usage) for values out of range. --iso is left to the caller.
MeshOutput readMeshOutput(const CommandLine& line);

/// The same if --output asks for a mesh; nothing for a .vdb file. Throws Error(ErrorKind::Usage)
/// for anything else that is no device or pipe, and for options that have no meaning with it.
std::optional<MeshOutput> readVdbOrMeshOutput(const CommandLine& line);

/// Makes a mesh of the grid's surface, says and counts what came of it, and writes it, with the
/// job's stamp. The last step of a command. `colors`: a grid of them, or null.
void writeMeshOutput(const ConvertJob& job, AtomicFile& output, const MeshOutput& options,
                     const openvdb::FloatGrid::ConstPtr& grid,
                     const openvdb::Vec3SGrid::ConstPtr& colors);

}  // namespace bandvox::app
