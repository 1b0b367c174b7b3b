// bandvox convert IN.vdb -o OUT.ply: the surface of a density or a level set, anybody's, as a mesh.

#include "convert_to_mesh.h"

#include "choose_grid.h"
#include "command_run.h"
#include "iso_option.h"
#include "mesh_output.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "words.h"

#include <bandvox/grid/grid_place.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <string>

namespace bandvox::app {

bool convertsGridToMesh(const CommandLine& line) {
    const std::string& input = line.positional(0);
    return !isShape(input) && extensionOf(input) == ".vdb" &&
           isWritableMesh(line.text("output").value_or(""));
}

void convertGridToMesh(ConvertJob& job) {
    const CommandLine& line = job.line();
    refuseOptions(
        line, {"resolution", "voxel-size", "cutoff", "order", "tolerance",   "tile",       "route",
               "oversample", "overlap",    "clamp",  "half",  "compression", "background", "factor",
               "onto",       "no-filter",  "lod",    "band",  "points",      "radius"},
        "where a mesh is made of a .vdb file, which is not filtered again");
    const std::string& input = line.positional(0);
    const StackRequest place = readStackRequest(line, input);
    MeshOutput options = readMeshOutput(line);
    const IsoOption iso = readIso(line, {});
    if (!job.begin()) return;
    CommandRun& run = job.run();
    AtomicFile output(options.path);

    openvdb::GridPtrVec grids;
    {
        const ProgressStage stage(run.progress(), "read", 0);
        grids = readGrids(input);
    }
    run.progress().throwIfInterrupted();
    const openvdb::FloatGrid::Ptr grid =
        chooseFloatGrid(grids, line.text("grid"), "density", input);
    // Colours are asked for by name if they are asked for.
    const openvdb::Vec3SGrid::Ptr colors = chooseColorGrid(
        grids, line.has("color") ? std::optional<std::string>("Cd") : std::nullopt, input);
    if (!place.space.empty()) {
        turnToSpace(*grid, place.space);
        // As the density is, of whose colours it is.
        if (colors) colors->setTransform(grid->transformPtr()->copy());
    }
    run.say("read     " + input + ": grid '" + grid->getName() + "', " +
            formatCount(static_cast<std::int64_t>(grid->activeVoxelCount()), "active voxel",
                        "active voxels") +
            (colors ? ", with colours" : ""));
    grids.clear();
    warnOfPart(run, *grid, input);
    options.iso = isoFor(run, iso, grid);
    writeMeshOutput(job, output, options, grid, colors);
}

}  // namespace bandvox::app
