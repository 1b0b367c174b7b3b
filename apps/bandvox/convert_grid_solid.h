#pragma once

#include "command_line.h"
#include "command_run.h"
#include "convert_job.h"
#include "lattice_request.h"

#include <bandvox/resample/resample_grid.h>

#include <openvdb/openvdb.h>

namespace bandvox::app {

/// The options of `convert` that say which solid a volume stands for.
std::vector<OptionEntry> gridSolidEntries();

/// True if `convert` is to take a .vdb file or an array as a solid.
bool takesSolidOfGrid(const CommandLine& line);

/// Runs `convert` for the solid of a .vdb file's grid, or of an array: what is above a value
/// becomes a band-limited density, a level set, fog or a mesh.
void convertGridSolid(ConvertJob& job);

/// The lattice and the filter for a grid.
struct RebuildRequest {
    const LatticeRequest& lattice;
    openvdb::GridBase::ConstPtr onto;  ///< what readOnto gave
    const ResampleOptions& resample;   ///< with a filter
};

/// A level set on another lattice: that of its solid's density.
openvdb::FloatGrid::Ptr rebuildLevelSet(CommandRun& run, const openvdb::FloatGrid::Ptr& levelSet,
                                        const RebuildRequest& request);

}  // namespace bandvox::app
