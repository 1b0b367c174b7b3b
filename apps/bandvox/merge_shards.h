#pragma once

#include "command_run.h"

#include <bandvox/grid/density_grid.h>

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

namespace bandvox::app {

/// True if one of the grids is a part of a larger one, as `convert --shard` makes them.
bool holdsShard(const openvdb::GridPtrVec& grids);

/// The grids that the files' parts join to, and the others, which one file has alone; says and
/// counts what came of it. `first`: the grids of the first file, which has been read. Throws
/// Error(ErrorKind::Input) if parts are missing or do not belong together.
openvdb::GridCPtrVec joinShardFiles(CommandRun& run, const std::vector<std::string>& inputs,
                                    const openvdb::GridPtrVec& first);

}  // namespace bandvox::app
