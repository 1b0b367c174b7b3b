#include "mesh_output.h"

#include "file_endings.h"
#include "words.h"

#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/write_mesh.h>

#include <nlohmann/json.hpp>

#include <cstdint>

namespace bandvox::app {
namespace {

void sayMesh(CommandRun& run, const MeshResult& result) {
    const auto points = static_cast<std::int64_t>(result.surface.mesh.points.size());
    const auto triangles = static_cast<std::int64_t>(result.surface.mesh.triangles.size());
    const auto collapsed = static_cast<std::int64_t>(result.pointsCollapsed);
    run.say("mesh     " + formatCount(points, "point", "points") + ", " +
            formatCount(triangles, "triangle", "triangles") +
            (result.surface.colors.empty() ? "" : ", coloured") +
            (collapsed > 0 ? ", " + formatCount(collapsed, "point", "points") + " left out" : "") +
            ", around a volume of " + formatNumber(result.volume, 8));
    run.count("mesh_points", points);
    run.count("mesh_triangles", triangles);
    run.count("mesh_volume", result.volume);
    run.count("mesh_colored", !result.surface.colors.empty());
    run.count("points_collapsed", collapsed);
    run.count("surface_cells", result.cells);
    run.count("ambiguous_faces", result.ambiguousFaces);
    run.count("iso", result.iso);
}

// Throws unless the output is named like a .vdb file or a mesh, or is a device or a pipe.
void requireVdbOrMesh(const std::filesystem::path& path) {
    std::error_code ignored;
    const bool isStream =
        std::filesystem::is_other(path, ignored) || path.string().starts_with("/dev/");
    std::vector<std::string> extensions{".vdb"};
    if (!isStream || isWritableMesh(path)) {
        const std::vector<std::string>& meshes = writableMeshExtensions();
        extensions.insert(extensions.end(), meshes.begin(), meshes.end());
        for (const char* array : {".npy", ".nrrd", ".nhdr", ".mha", ".mhd", ".tif", "####.png"}) {
            extensions.emplace_back(array);
        }
    }
    requireExtension(path, extensions);
}

}  // namespace

OptionEntry meshOrVdbOutputEntry() {
    return {
        "output",
        'o',
        "FILE",
        "",
        "The .vdb file to write, stdout.vdb is the standard output; a .usda file, which refers to "
        "a "
        ".vdb file of its name that is written beside it; or a mesh of the surface (" +
            joined(writableMeshExtensions(), " ") +
            "), an array (.npy .nrrd .nhdr .mha .mhd), or images of slices (out.####.png, .exr or "
            ".tif; one .tif). Needed.",
        "Output",
        {.endings = convertedEndings()}};
}

OptionEntry adaptivityEntry() {
    return {"adaptivity",
            0,
            "A",
            formatNumber(MeshOptions().adaptivity),
            "Leave points of a mesh out where the surface hardly bends, 0 to 1: what is left stays "
            "within a quarter of a voxel times A of what was there.",
            "Output"};
}

void refuseOptions(const CommandLine& line, const std::vector<std::string>& options,
                   const std::string& where) {
    for (const std::string& option : options) {
        if (!line.has(option)) continue;
        std::string message = "--" + option;
        message += " has no meaning " + where;
        throw Error(ErrorKind::Usage, message);
    }
}

MeshOutput readMeshOutput(const CommandLine& line) {
    MeshOutput options;
    options.path = line.requiredText("output");
    options.adaptivity = line.number("adaptivity", {.low = 0, .high = 1}, MeshOptions().adaptivity);
    if (line.has("color") && !holdsColors(options.path)) {
        throw Error(ErrorKind::Usage, "--color has no meaning with '" + options.path.string() +
                                          "', which holds no colours; expected another kind of "
                                          "mesh file");
    }
    return options;
}

std::optional<MeshOutput> readVdbOrMeshOutput(const CommandLine& line) {
    const std::string output = line.requiredText("output");
    requireVdbOrMesh(output);
    if (!isWritableMesh(output)) {
        refuseOptions(line, {"adaptivity"}, "with a .vdb file as the output");
        return std::nullopt;
    }
    refuseOptions(line, {"half", "compression", "lod", "shard"}, "with a mesh as the output");
    return readMeshOutput(line);
}

void writeMeshOutput(const ConvertJob& job, AtomicFile& output, const MeshOutput& options,
                     const openvdb::FloatGrid::ConstPtr& grid,
                     const openvdb::Vec3SGrid::ConstPtr& colors) {
    CommandRun& run = job.run();
    MeshOptions mesh;
    mesh.iso = options.iso;
    mesh.adaptivity = options.adaptivity;
    if (holdsColors(options.path)) mesh.colors = colors;
    MeshResult result = densityToMesh(grid, mesh, run.progress());
    sayMesh(run, result);
    run.warn(result.warnings, ErrorKind::Result);
    result.surface.notes = toNotes(job.stamp());
    run.writeOutput(output,
                    [&](AtomicFile& file) { writeMesh(file, result.surface, run.progress()); });
}

}  // namespace bandvox::app
