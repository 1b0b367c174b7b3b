// bandvox voxelize: a mesh or a built-in shape to binary voxels in a .vdb file.

#include "command_run.h"
#include "commands.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/source/shapes.h>
#include <bandvox/voxelize/field_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

namespace bandvox::app {
namespace {

// How far the volume of the voxels may be from the solid's, relative, before it is worth a word.
constexpr double kVolumeError = 0.05;

struct VoxelizeRequest {
    std::string input;
    std::filesystem::path output;
    VoxelOptions voxels;
    VdbWriteOptions write;
};

/// The voxels of a solid, and its own volume.
struct VoxelizedSolid {
    VoxelResult result;
    double sourceVolume = 0;  ///< world units³
};

VoxelizeRequest parseVoxelize(const CommandLine& line) {
    VoxelizeRequest request;
    request.input = line.positional(0);
    const std::string output = line.requiredText("output");
    requireExtension(output, {".vdb"});
    request.output = outputPath(output);
    readSize(line, request.voxels.resolution, request.voxels.voxelSize);
    request.write.compression = readCompression(line);
    return request;
}

VoxelizedSolid voxelize(CommandRun& run, const VoxelizeRequest& request) {
    if (isShape(request.input)) {
        const auto field = makeShapeField(request.input);
        run.say("read     " + request.input);
        return {fieldToVoxels(*field, request.voxels, run.progress()),
                makeShapeBoundary(request.input)->volume()};
    }
    SolidMesh mesh = loadSolidMesh(run, request.input, {});
    const MeshSource source(mesh.name, std::move(mesh.solid));
    return {meshToVoxels(source, request.voxels, run.progress()), source.volume()};
}

/// Says what was made; warns if the voxels are too few to tell the solid's size.
void sayResult(CommandRun& run, VoxelizedSolid& solid) {
    const openvdb::FloatGrid& grid = *solid.result.grid;
    const openvdb::Coord size = grid.evalActiveVoxelBoundingBox().dim();
    run.say("grid     " + std::to_string(size.x()) + " x " + std::to_string(size.y()) + " x " +
            std::to_string(size.z()) + " voxels of side " + formatNumber(grid.voxelSize().x()) +
            ", " + formatCount(solid.result.voxels, "voxel inside", "voxels inside"));
    const double volume = static_cast<double>(solid.result.voxels) * grid.transform().voxelVolume();
    run.count("voxels_inside", solid.result.voxels);
    run.count("grid_volume", volume);
    const double difference = std::abs(volume - solid.sourceVolume) / solid.sourceVolume;
    run.say("volume   source " + formatNumber(solid.sourceVolume, 8) + ", grid " +
            formatNumber(volume, 8) + ", relative difference " + formatNumber(difference, 2));
    run.count("source_volume", solid.sourceVolume);
    if (difference > kVolumeError) {
        solid.result.warnings.push_back(
            "the voxels hold " + formatNumber(100 * difference, 2) + " % " +
            (volume < solid.sourceVolume ? "less" : "more") +
            " than the solid, which is small in voxels; use more of them");
    }
}

}  // namespace

const CommandTable& voxelizeTable() {
    static const CommandTable table{
        "voxelize",
        "Turn a mesh or a built-in shape into binary voxels (.vdb).",
        "Makes voxels that are 1 where their centres are inside the solid, and nothing elsewhere: "
        "no values in between, so staircases. 'bandvox convert' makes smooth densities. Holes of "
        "the mesh are capped, and said so.",
        {solidInputEntry()},
        {
            resolutionEntry(VoxelOptions().resolution),
            voxelSizeEntry(),
            vdbOutputEntry(),
            compressionEntry(),
        },
        {
            {"bandvox voxelize bunny.obj -o voxels.vdb --resolution 512",
             "512 voxels along the bunny's longest side."},
            {"bandvox voxelize shape:hyperboloid -o voxels.vdb --resolution 64",
             "A shape, by its formula."},
        }};
    return table;
}

void runVoxelize(const CommandLine& line) {
    const VoxelizeRequest request = parseVoxelize(line);
    requireMeshOrShape("voxelize", request.input);
    CommandRun run(line);
    AtomicFile output(request.output);

    VoxelizedSolid solid = voxelize(run, request);
    sayResult(run, solid);
    run.warn(solid.result.warnings, ErrorKind::Result);

    run.writeOutput(output,
                    [&](AtomicFile& file) { writeVdb(file, {solid.result.grid}, request.write); });
}

}  // namespace bandvox::app
