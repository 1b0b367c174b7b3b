#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <string>

namespace bandvox::app {

/// True for "stdin.vdb", which names the standard input.
bool isStandardInput(const std::string& name);

/// Reads the grids of a .vdb file, or of the standard input if it has that name. Throws what
/// readVdb does, and Error(ErrorKind::Usage) if the standard input is a terminal.
openvdb::GridPtrVec readGrids(const std::string& name);

/// The path to write to for a name given to --output: "stdout.vdb" names the standard output,
/// as do "stdout.npy" and "stdout.nrrd".
/// Throws Error(ErrorKind::Usage) if that is a terminal, or for "stdin.vdb".
std::filesystem::path outputPath(const std::string& name);

}  // namespace bandvox::app
