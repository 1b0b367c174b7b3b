#pragma once

#include "command_run.h"

#include <openvdb/openvdb.h>

#include <string>

namespace bandvox::app {

/// Throws Error(ErrorKind::Input), which says that one cannot `verb` it and how to make a .vdb file
/// of it if that is possible, unless `input` is named like a .vdb file.
void requireVdb(const std::string& verb, const std::string& input);

/// Warns that a grid of `file` is a part of a larger one, as `convert --shard` makes them: where it
/// was cut, what is made of it is not what the whole would give.
void warnOfPart(CommandRun& run, const openvdb::GridBase& grid, const std::string& file);

}  // namespace bandvox::app
