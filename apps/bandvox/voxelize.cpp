// bandvox voxelize: a mesh or a built-in shape to binary voxels in a .vdb file.

#include "command_run.h"
#include "commands.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>
#include <bandvox/voxelize/field_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>
#include <bandvox/voxelize/soup_to_voxels.h>

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace bandvox::app {
namespace {

// How far the volume of the voxels may be from the solid's, relative, before it is worth a word.
constexpr double kVolumeError = 0.05;

enum class Backend { Auto, Cpu, Gpu };

struct VoxelizeRequest {
    std::string input;
    std::filesystem::path output;
    VoxelOptions voxels;
    bool asMask = false;
    Backend backend = Backend::Auto;
    GpuMethod gpuMethod = GpuMethod::Bits;
    VdbWriteOptions write;
};

/// The voxels of a solid, and its own volume.
struct VoxelizedSolid {
    VoxelResult result;
    std::optional<double> sourceVolume;  ///< world units³, if it is known
};

void refuseTogether(const CommandLine& line, const std::string& one, const std::string& other) {
    if (!line.has(one) || !line.has(other)) return;
    throw Error(ErrorKind::Usage,
                "--" + one + " and --" + other + " exclude each other; expected one of them");
}

void readSamples(const CommandLine& line, VoxelizeRequest& request) {
    refuseTogether(line, "threshold", "fraction");
    VoxelOptions& voxels = request.voxels;
    if (line.has("threshold")) voxels.threshold = line.wholeNumber("threshold", 1, 8, 0);
    voxels.fraction = line.has("fraction");
    voxels.axis = std::array{ScanAxis::X, ScanAxis::Y, ScanAxis::Z}[line.choice("axis", 0)];
    request.asMask = line.choice("as", 0) == 1;
    if (request.asMask && voxels.fraction) {
        throw Error(ErrorKind::Usage,
                    "a mask cannot hold what --fraction gives; expected --as density, or "
                    "--threshold");
    }
}

void readBackend(const CommandLine& line, VoxelizeRequest& request) {
    request.backend =
        std::array{Backend::Auto, Backend::Cpu, Backend::Gpu}[line.choice("backend", 0)];
    request.gpuMethod =
        std::array{GpuMethod::Bits, GpuMethod::Slices}[line.choice("gpu-method", 0)];
    if (line.has("gpu-method") && request.backend == Backend::Cpu) {
        throw Error(ErrorKind::Usage,
                    "--gpu-method says how the GPU works; expected --backend gpu or auto");
    }
    if (request.backend == Backend::Gpu && isShape(request.input)) {
        throw Error(ErrorKind::Usage, "the GPU voxelizes meshes, and '" + request.input +
                                          "' is a formula; expected --backend cpu or auto");
    }
}

VoxelizeRequest parseVoxelize(const CommandLine& line) {
    VoxelizeRequest request;
    request.input = line.positional(0);
    const std::string output = line.requiredText("output");
    requireExtension(output, {".vdb"});
    request.output = outputPath(output);
    readSize(line, request.voxels.resolution, request.voxels.voxelSize);
    readSamples(line, request);
    readBackend(line, request);
    request.write.compression = readCompression(line);
    return request;
}

/// The voxels of a mesh by the GPU; nothing if they are left to the CPU, which gets said.
std::optional<VoxelResult> voxelizeOnGpu(CommandRun& run, const VoxelizeRequest& request,
                                         const MeshSource& mesh) {
    if (request.backend == Backend::Cpu) return std::nullopt;
    const bool canChoose = request.backend == Backend::Auto;
    if (canChoose) {
        const OpenGlDevice gpu = findGpu();
        if (!gpu.isHardware) {
            run.say("backend  cpu: " + gpu.description);
            return std::nullopt;
        }
    }
    try {
        VoxelResult result =
            meshToVoxelsOnGpu(mesh, request.voxels, request.gpuMethod, run.progress());
        run.say("backend  gpu: " + result.device);
        return result;
    } catch (const Error& error) {
        const bool isDevices = error.kind() == ErrorKind::Runtime ||
                               error.kind() == ErrorKind::Memory ||
                               error.kind() == ErrorKind::Usage;
        if (!canChoose || !isDevices) throw;
        run.say(std::string("backend  cpu: ") + error.what());
        return std::nullopt;
    }
}

VoxelizedSolid voxelize(CommandRun& run, const VoxelizeRequest& request) {
    if (isShape(request.input)) {
        const auto field = makeShapeField(request.input);
        run.say("read     " + request.input);
        return {fieldToVoxels(*field, request.voxels, run.progress()),
                makeShapeBoundary(request.input)->volume()};
    }
    SolidMesh mesh = loadSolidMesh(run, request.input, {});
    if (!mesh.soup.triangles.empty()) {
        if (request.backend == Backend::Gpu) {
            throw Error(ErrorKind::Usage,
                        "the GPU voxelizes what is closed, and what of '" + request.input +
                            "' is not goes by its winding number; expected --backend cpu or auto");
        }
        return {soupToVoxels({mesh.name, std::move(mesh.soup), std::move(mesh.solid)},
                             request.voxels, run.progress()),
                std::nullopt};
    }
    const MeshSource source(mesh.name, std::move(mesh.solid));
    std::optional<VoxelResult> result = voxelizeOnGpu(run, request, source);
    if (!result) result = meshToVoxels(source, request.voxels, run.progress());
    return {std::move(*result), source.volume()};
}

/// Says what was made; warns if the voxels are too few to tell the solid's size.
void sayResult(CommandRun& run, const VoxelizeRequest& request, VoxelizedSolid& solid) {
    const openvdb::FloatGrid& grid = *solid.result.grid;
    const openvdb::Coord size = grid.evalActiveVoxelBoundingBox().dim();
    const std::string where = request.voxels.fraction ? " inside or in part" : " inside";
    run.say("grid     " + std::to_string(size.x()) + " x " + std::to_string(size.y()) + " x " +
            std::to_string(size.z()) + " voxels of side " + formatNumber(grid.voxelSize().x()) +
            ", " + formatCount(solid.result.voxels, "voxel", "voxels") + where);
    const double volume = solid.result.volume;
    run.count("voxels_inside", solid.result.voxels);
    run.count("backend", solid.result.device.empty() ? "cpu" : "gpu");
    if (!solid.result.device.empty()) run.count("device", solid.result.device);
    run.count("grid_volume", volume);
    if (!solid.sourceVolume) {
        run.say("volume   grid " + formatNumber(volume, 8));
        return;
    }
    const double expected = *solid.sourceVolume;
    const double difference = std::abs(volume - expected) / expected;
    run.say("volume   source " + formatNumber(expected, 8) + ", grid " + formatNumber(volume, 8) +
            ", relative difference " + formatNumber(difference, 2));
    run.count("source_volume", expected);
    if (difference > kVolumeError) {
        solid.result.warnings.push_back(
            "the voxels hold " + formatNumber(100 * difference, 2) + " % " +
            (volume < expected ? "less" : "more") +
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
        "the mesh are capped, and said so. A voxel may be judged by eight samples, the centres of "
        "its octants, instead of by its centre. All backends and axes give the same voxels.",
        {solidInputEntry()},
        {
            resolutionEntry(VoxelOptions().resolution),
            voxelSizeEntry(),
            {"threshold", 0, "T", "",
             "Take eight samples in each voxel, of which T, 1 to 8, have to be inside.", "Voxels"},
            {"fraction", 0, "", "",
             "Take eight samples in each voxel; its value is the share of them inside.", "Voxels"},
            {"axis",
             0,
             "AXIS",
             "x",
             "Along which axis rows are scanned: x, y or z.",
             "Voxels",
             {.words = {"x", "y", "z"}}},
            {"backend",
             0,
             "NAME",
             "auto",
             "cpu; gpu, which is OpenGL without a window, for meshes; or auto: a GPU if there is "
             "one, not a program that stands in for it.",
             "Voxels",
             {.words = {"auto", "cpu", "gpu"}}},
            {"gpu-method",
             0,
             "NAME",
             "bits",
             "bits: all slices are drawn at once; slices: one by one, for comparison.",
             "Voxels",
             {.words = {"bits", "slices"}}},
            {"as",
             0,
             "KIND",
             "density",
             "density: a grid of floats; mask: one of booleans, true inside.",
             "Output",
             {.words = {"density", "mask"}}},
            vdbOutputEntry(),
            compressionEntry(),
        },
        {
            {"bandvox voxelize bunny.obj -o voxels.vdb --resolution 512",
             "512 voxels along the bunny's longest side."},
            {"bandvox voxelize bunny.obj -o voxels.vdb --fraction", "Values in steps of 1/8."},
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
    sayResult(run, request, solid);
    run.warn(solid.result.warnings, ErrorKind::Result);

    run.writeOutput(output, [&](AtomicFile& file) {
        openvdb::GridBase::ConstPtr grid = solid.result.grid;
        if (request.asMask) grid = voxelsToMask(*solid.result.grid);
        writeVdb(file, {grid}, request.write);
    });
}

}  // namespace bandvox::app
