// bandvox convert: a mesh or a built-in shape to a band-limited density in a .vdb file.

#include "command_run.h"
#include "commands.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

namespace bandvox::app {
namespace {

constexpr int kFinestResolution = 1'000'000;
constexpr int kLargestTile = 512;
constexpr std::size_t kHolesListed = 3;  // without --verbose

struct ConvertRequest {
    std::string input;
    std::filesystem::path output;
    DensityOptions density;
    VdbWriteOptions write;
};

/// A solid, and what was done to make it one.
struct Solid {
    std::unique_ptr<BoundarySource> source;
    int holesCapped = 0;
};

ConvertRequest parseConvert(const CommandLine& line) {
    ConvertRequest request;
    request.input = line.positional(0);
    const std::string output = line.requiredText("output");
    requireExtension(output, {".vdb"});
    request.output = outputPath(output);

    DensityOptions& density = request.density;
    if (line.has("resolution") && line.has("voxel-size")) {
        throw Error(ErrorKind::Usage,
                    "--resolution and --voxel-size exclude each other; expected one of them");
    }
    density.resolution = line.wholeNumber("resolution", 1, kFinestResolution, density.resolution);
    density.voxelSize = line.number("voxel-size", {.low = 0, .lowOpen = true}, density.voxelSize);
    density.filter.cutoff =
        line.number("cutoff", {.low = 0.01, .high = 0.5}, density.filter.cutoff);
    density.filter.order = line.number("order", {.low = 0.5, .high = 64}, density.filter.order);
    density.tolerance = line.number("tolerance", {.low = 1e-6, .high = 0.05}, density.tolerance);
    density.tile = line.wholeNumber("tile", 0, kLargestTile, density.tile);
    if (density.tile % 2 != 0) {
        throw Error(ErrorKind::Usage, "option --tile is '" + std::to_string(density.tile) +
                                          "'; expected an even number");
    }
    density.iso =
        line.number("iso", {.low = 0, .high = 1, .lowOpen = true, .highOpen = true}, density.iso);
    density.clamp = line.has("clamp");

    using Compression = VdbWriteOptions::Compression;
    request.write.half = line.has("half");
    request.write.compression =
        std::array{Compression::Blosc, Compression::Zip,
                   Compression::None}[line.choice("compression", {"blosc", "zip", "none"}, 0)];
    return request;
}

void requireMeshOrShape(const std::string& input) {
    if (isShape(input) || isMeshFile(input)) return;
    const std::string extension = extensionOf(input);
    const std::string found = extension.empty() ? "it has no extension"
                              : extension == ".vdb"
                                  ? "it is a VDB already"
                                  : "'" + extension + "' is no kind of file that can be read";
    throw Error(ErrorKind::Input, "cannot convert '" + input + "': " + found +
                                      "; expected a mesh (" + joined(meshExtensions(), " ") +
                                      ") or a shape (shape:" + joined(shapeNames(), " shape:") +
                                      ")");
}

void sayHoles(CommandRun& run, const std::vector<CappedHole>& holes) {
    if (holes.empty()) return;
    const std::size_t listed = run.verbose() ? holes.size() : std::min(holes.size(), kHolesListed);
    run.say("capped   " + formatCount(static_cast<std::int64_t>(holes.size()), "hole", "holes") +
            ":");
    for (std::size_t i = 0; i < listed; ++i) {
        run.say("         " + std::to_string(holes[i].edges) + " edges, perimeter " +
                formatNumber(holes[i].perimeter) + ", around " + formatVector(holes[i].center));
    }
    if (listed < holes.size()) {
        run.say("         and " + std::to_string(holes.size() - listed) +
                " smaller ones (--verbose lists them)");
    }
}

void sayRepairs(CommandRun& run, const CloseMeshReport& report) {
    std::vector<std::string> parts;
    const auto add = [&](std::size_t count, const char* one, const char* many) {
        if (count > 0) {
            parts.push_back(formatCount(static_cast<std::int64_t>(count), one, many));
        }
    };
    add(report.components, "piece", "pieces");
    add(report.pointsWelded, "point welded", "points welded");
    add(report.degenerateTriangles, "triangle without area dropped",
        "triangles without area dropped");
    add(report.trianglesFlipped, "triangle flipped", "triangles flipped");
    add(report.componentsTurned, "piece turned outward", "pieces turned outward");
    add(report.nonManifoldEdges, "edge of more than two triangles",
        "edges of more than two triangles");
    run.say("solid    " + joined(parts, ", "));
    sayHoles(run, report.holes);
}

Solid loadMesh(CommandRun& run, const std::filesystem::path& path) {
    MeshFile file = readMesh(path, run.progress());
    run.say("read     " + path.string() + ": " +
            formatCount(static_cast<std::int64_t>(file.mesh.points.size()), "point", "points") +
            ", " +
            formatCount(static_cast<std::int64_t>(file.mesh.triangles.size()), "triangle",
                        "triangles") +
            ", " + formatCount(static_cast<std::int64_t>(file.objects), "object", "objects"));
    run.count("points", file.mesh.points.size());
    run.count("triangles", file.mesh.triangles.size());
    run.count("objects", file.objects);
    run.warn(file.warnings, ErrorKind::Input);

    ClosedMesh closed = closeMesh(std::move(file.mesh), {}, run.progress());
    sayRepairs(run, closed.report);
    run.count("holes_capped", closed.report.holes.size());
    run.warn(closed.report.warnings, ErrorKind::Input);
    return {std::make_unique<MeshSource>(path.filename().string(), std::move(closed.mesh)),
            static_cast<int>(closed.report.holes.size())};
}

Solid loadSolid(CommandRun& run, const std::string& input) {
    if (!isShape(input)) return loadMesh(run, input);
    Solid solid{makeShapeBoundary(input), 0};
    run.say("read     " + input);
    return solid;
}

void sayResult(CommandRun& run, const DensityResult& result) {
    const DensityMetadata& metadata = result.metadata;
    const auto activeVoxels = static_cast<std::int64_t>(result.grid->activeVoxelCount());
    const openvdb::Coord size = result.grid->evalActiveVoxelBoundingBox().dim();
    run.say("grid     " + std::to_string(size.x()) + " x " + std::to_string(size.y()) + " x " +
            std::to_string(size.z()) + " voxels of side " +
            formatNumber(result.grid->voxelSize().x()) + ", " +
            formatCount(activeVoxels, "active voxel", "active voxels") + ", density " +
            formatNumber(result.minimum) + " to " + formatNumber(result.maximum));
    run.sayMore("tiles    " + std::to_string(result.tiles) + " of side " +
                std::to_string(result.tileSide) + " with a halo of " + std::to_string(result.halo) +
                ", spread over " + std::to_string(result.kernelWidth) + " voxels from " +
                formatCount(result.surfaceSamples, "surface sample", "surface samples"));
    run.say("error    " + formatNumber(metadata.closureError, 2) +
            " measured by closure, tolerance " + formatNumber(metadata.tolerance, 2));
    const double difference =
        metadata.sourceVolume != 0
            ? std::abs(metadata.gridVolume - metadata.sourceVolume) / metadata.sourceVolume
            : 0;
    run.say("volume   source " + formatNumber(metadata.sourceVolume, 8) + ", grid " +
            formatNumber(metadata.gridVolume, 8) + ", relative difference " +
            formatNumber(difference, 2));

    run.count("active_voxels", activeVoxels);
    run.count("surface_samples", result.surfaceSamples);
    run.count("tiles", result.tiles);
    run.count("tile_side", result.tileSide);
    run.count("halo", result.halo);
    run.count("kernel_width", result.kernelWidth);
    run.count("spread_thread_seconds", result.spreadSeconds);
    run.count("transform_thread_seconds", result.transformSeconds);
    run.count("closure_error", metadata.closureError);
    run.count("source_volume", metadata.sourceVolume);
    run.count("grid_volume", metadata.gridVolume);
}

}  // namespace

const CommandTable& convertTable() {
    static const CommandTable table = [] {
        const DensityOptions density;
        const std::string size = "Size";
        const std::string filter = "Filter";
        const std::string output = "Output";
        return CommandTable{
            "convert",
            "Turn a mesh or a built-in shape into a band-limited density (.vdb).",
            "Turns the solid inside a mesh into a density on a grid: 1 inside, 0 outside, and in "
            "between only what the grid can hold. The solid is filtered before it is sampled, so "
            "nothing aliases; the error is measured and stored in the grid. Holes of the mesh are "
            "capped, and said so.",
            {{"INPUT", "A mesh (" + joined(meshExtensions(), " ") +
                           ") or a built-in shape (shape:" + joined(shapeNames(), " shape:") +
                           ")."}},
            {
                {"resolution", 'r', "N", std::to_string(density.resolution),
                 "Voxels along the longest side of the object's box.", size},
                {"voxel-size", 0, "S", "", "Side of a voxel in world units, instead.", size},
                {"cutoff", 0, "K", formatNumber(density.filter.cutoff),
                 "Cutoff k_c of the filter exp(-(k/k_c)^n), in cycles per voxel, 0.01 to 0.5.",
                 filter},
                {"order", 0, "N", formatNumber(density.filter.order),
                 "Order n of the filter, 0.5 to 64. 2 never rings; more keeps more detail and "
                 "overshoots at flat faces.",
                 filter},
                {"tolerance", 0, "E", formatNumber(density.tolerance),
                 "Error of the density that is allowed, 1e-6 to 0.05.", filter},
                {"tile", 0, "N", "chosen",
                 "Side of the cube that is filtered at a time, in voxels, even, at most 512.",
                 filter},
                {"clamp", 0, "", "", "Limit the density to 0 .. 1, which cuts off ringing.",
                 filter},
                {"iso", 0, "D", formatNumber(density.iso),
                 "Density that is the surface, for the commands that come after.", filter},
                {"output", 'o', "FILE", "",
                 "The .vdb file to write; stdout.vdb is the standard output. Needed.", output},
                {"half", 0, "", "", "Store 16-bit values.", output},
                {"compression", 0, "KIND", "blosc", "blosc, zip or none.", output},
            },
            {
                {"bandvox convert bunny.obj -o bunny.vdb --resolution 512",
                 "512 voxels along the bunny's longest side."},
                {"bandvox convert shape:torus -o torus.vdb --order 4 --cutoff 0.25",
                 "A sharper filter, that keeps more detail and rings by 5 %."},
                {"bandvox convert part.stl -o part.vdb --voxel-size 0.1 --strict",
                 "Voxels of a given size, and no result if anything about the mesh is doubtful."},
            }};
    }();
    return table;
}

void runConvert(const CommandLine& line) {
    const ConvertRequest request = parseConvert(line);
    requireMeshOrShape(request.input);
    CommandRun run(line);
    AtomicFile output(request.output);

    Solid solid = loadSolid(run, request.input);
    DensityResult result = surfaceToDensity(*solid.source, request.density, run.progress());
    result.metadata.holesCapped = solid.holesCapped;
    setDensityMetadata(*result.grid, result.metadata);
    sayResult(run, result);
    run.warn(result.warnings, ErrorKind::Result);

    run.writeOutput(output,
                    [&](AtomicFile& file) { writeVdb(file, {result.grid}, request.write); });
}

}  // namespace bandvox::app
