// bandvox render: a density in a .vdb file to a picture.

#include "command_run.h"
#include "commands.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "words.h"

#include <bandvox/render/density_to_image.h>
#include <bandvox/render/image.h>
#include <bandvox/render/shading.h>

#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <optional>

namespace bandvox::app {
namespace {

constexpr int kMostPixels = 65536;  // along a side
constexpr int kMostSamples = 1024;
const Range kPositive{.low = 0, .lowOpen = true};
const Range kColor{.low = 0};
const Range kPlace{.low = -1e30, .high = 1e30};  // the squares of more are not finite

struct RenderRequest {
    std::string input;
    std::filesystem::path output;
    std::optional<std::string> grid;
    RenderOptions options;
};

CameraOptions parseCamera(const CommandLine& line) {
    CameraOptions camera;
    using Projection = CameraOptions::Projection;
    camera.projection = std::array{
        Projection::Perspective,
        Projection::Orthographic}[line.choice("camera", {"perspective", "orthographic"}, 0)];
    camera.eye = line.vector("eye", kPlace);
    camera.lookat = line.vector("lookat", kPlace);
    camera.up = line.vector("up", kPlace);
    camera.from = line.vector("from", kPlace).value_or(camera.from);
    camera.focal = line.number("focal", kPositive, camera.focal);
    camera.aperture = line.number("aperture", kPositive, camera.aperture);
    camera.frame = line.number("frame", {.low = 0}, camera.frame);
    return camera;
}

RenderRequest parseRender(const CommandLine& line) {
    RenderRequest request;
    request.input = line.positional(0);
    request.output = line.requiredText("output");
    requireExtension(request.output, {".png", ".exr"});
    request.grid = line.text("grid");

    RenderOptions& options = request.options;
    if (const auto size = line.size("res", 1, kMostPixels)) {
        options.width = size->x();
        options.height = size->y();
    }
    options.samples = line.wholeNumber("samples", 1, kMostSamples, options.samples);
    options.camera = parseCamera(line);
    options.shading = static_cast<Shading>(line.choice("shading", shadingNames(), 0));
    if (line.has("iso")) options.iso = line.number("iso", {}, 0);
    options.light = line.vector("light", kPlace).value_or(options.light);
    options.color = line.vector("color", kColor).value_or(options.color);
    options.ambient = line.number("ambient", {.low = 0, .high = 1}, options.ambient);
    options.background = line.vector("background", kColor);
    options.allowEmpty = line.has("allow-empty");
    requireValid(options);
    return request;
}

std::string listed(const openvdb::GridPtrVec& grids) {
    if (grids.empty()) return "no grids";
    std::vector<std::string> names;
    for (const auto& grid : grids) {
        names.push_back("'" + grid->getName() + "' (" + grid->valueType() + ")");
    }
    return "the grids " + joined(names, ", ");
}

/// The grid that is asked for; without a name the first of floats named density, else the only
/// one of floats.
openvdb::FloatGrid::Ptr chooseGrid(const openvdb::GridPtrVec& grids,
                                   const std::optional<std::string>& name,
                                   const std::string& file) {
    const std::string wanted = name.value_or("density");
    openvdb::FloatGrid::Ptr only;
    std::size_t floats = 0;
    for (const auto& grid : grids) {
        auto floatGrid = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        if (!floatGrid) continue;
        if (grid->getName() == wanted) return floatGrid;
        only = floatGrid;
        ++floats;
    }
    if (!name && floats == 1) return only;
    throw Error(ErrorKind::Input,
                "'" + file + "' has " + listed(grids) + "; expected " +
                    (name ? "a float grid '" + *name + "'"
                          : "a float grid 'density', or one float grid only (--grid names one)"));
}

}  // namespace

const CommandTable& renderTable() {
    static const CommandTable table = [] {
        const RenderOptions options;
        const CameraOptions& camera = options.camera;
        const auto vector = [](const openvdb::Vec3d& v) {
            return formatNumber(v.x()) + "," + formatNumber(v.y()) + "," + formatNumber(v.z());
        };
        const std::string picture = "Picture";
        const std::string view = "Camera";
        const std::string look = "Surface and light";
        return CommandTable{
            "render",
            "Draw the surface of a density (.vdb) as a picture (.png, .exr).",
            "Draws the surface where the density is 0.5, or as given. Lines of sight are followed "
            "to the band-limited density that the grid stands for, and the normal is its "
            "gradient, so the picture shows no voxels. Densities and level sets of other programs "
            "are read by the cubic spline through their values. An .exr also holds depth (Z), "
            "normals (N) and positions (P).",
            {{"INPUT", "A .vdb file; stdin.vdb is the standard input."}},
            {
                {"output", 'o', "FILE", "", "The .png or .exr file to write. Needed.", picture},
                {"res", 0, "WxH",
                 std::to_string(options.width) + "x" + std::to_string(options.height),
                 "Width and height, pixels.", picture},
                {"samples", 0, "N", std::to_string(options.samples), "Lines of sight per pixel.",
                 picture},
                {"background", 0, "R,G,B", "transparent", "Linear colour behind the object.",
                 picture},
                {"allow-empty", 0, "", "",
                 "Write a picture even if nothing is seen, as of the empty frames of a sequence.",
                 picture},
                {"camera", 0, "KIND", "perspective", "perspective or orthographic.", view},
                {"eye", 0, "X,Y,Z", "chosen", "Where the camera is, world.", view},
                {"lookat", 0, "X,Y,Z", "the middle", "What it looks at, world.", view},
                {"up", 0, "X,Y,Z", "0,1,0, or z along y", "What is up in the picture.", view},
                {"from", 0, "X,Y,Z", vector(camera.from),
                 "Direction from the object to the camera, if --eye is not given.", view},
                {"focal", 0, "MM", formatNumber(camera.focal), "Focal length in mm (perspective).",
                 view},
                {"aperture", 0, "MM", formatNumber(camera.aperture),
                 "Width of the film in mm (perspective).", view},
                {"frame", 0, "W", "fits",
                 "Width of the view in world units (orthographic); 0 fits the object.", view},
                {"grid", 0, "NAME", "density, or the only one of floats", "Which grid to draw.",
                 look},
                {"iso", 0, "D", "as stored, else 0.5",
                 "Density that is the surface; of a level set the distance, by default 0.", look},
                {"shading", 0, "KIND", shadingNames().front(),
                 joined(shadingNames(), ", ") +
                     ": where normals come from. All but the first see voxels as cubes, show "
                     "stripes, and are here for comparison.",
                 look},
                {"light", 0, "X,Y,Z", vector(options.light),
                 "Direction to the light, along the camera's right, up and back.", look},
                {"color", 0, "R,G,B", vector(options.color), "Linear colour of the surface.", look},
                {"ambient", 0, "A", formatNumber(options.ambient), "Light from everywhere, 0 to 1.",
                 look},
            },
            {
                {"bandvox render bunny.vdb -o bunny.png",
                 "The whole object, on a transparent ground."},
                {"bandvox render bunny.vdb -o bunny.exr --res 1920x1080 --samples 4",
                 "With depth, normals and positions, four lines of sight per pixel."},
                {"bandvox render bunny.vdb -o front.png --camera orthographic --from 0,0,1",
                 "A parallel view along -z."},
            }};
    }();
    return table;
}

void runRender(const CommandLine& line) {
    const RenderRequest request = parseRender(line);
    requireVdb("render", request.input);
    CommandRun run(line);
    AtomicFile output(request.output);

    openvdb::GridPtrVec grids;
    {
        const ProgressStage stage(run.progress(), "read", 0);
        grids = readGrids(request.input);
    }
    const openvdb::FloatGrid::Ptr grid = chooseGrid(grids, request.grid, request.input);
    grids.clear();
    run.say("read     " + request.input + ": grid '" + grid->getName() + "', " +
            formatCount(static_cast<std::int64_t>(grid->activeVoxelCount()), "active voxel",
                        "active voxels"));

    const RenderResult result = densityToImage(grid, request.options, run.progress());
    run.say("drawn    " + std::to_string(result.image.width) + " x " +
            std::to_string(result.image.height) + " pixels, " +
            formatCount(result.rays, "line of sight", "lines of sight") + ", " +
            formatCount(result.hits, "hit", "hits"));
    run.count("rays", result.rays);
    run.count("hits", result.hits);

    run.writeOutput(output,
                    [&](AtomicFile& file) { writeImage(file, result.image, run.progress()); });
}

}  // namespace bandvox::app
