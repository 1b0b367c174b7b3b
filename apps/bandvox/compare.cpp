// bandvox compare: how far two volumes, or their surfaces, are from each other.

#include "choose_grid.h"
#include "command_run.h"
#include "commands.h"
#include "compare_report.h"
#include "file_endings.h"
#include "iso_option.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "words.h"

#include <bandvox/compare/grid_to_surface.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::app {

namespace {

const std::vector<std::string>& metricNames() {
    static const std::vector<std::string> names{"max",    "rms",      "hausdorff", "mean-distance",
                                                "volume", "integral", "angle"};
    return names;
}

enum class Metric { Maximum, Rms, Hausdorff, MeanDistance, Volume, Integral, Angle };

bool isOfValues(Metric metric) {
    return metric == Metric::Maximum || metric == Metric::Rms || metric == Metric::Integral;
}

struct CompareRequest {
    std::array<std::string, 2> inputs;
    std::optional<std::string> grid;
    IsoOption iso;
    bool values = true, surfaces = true;
    double tolerance = 0;  // of the largest distance, voxels
    int cuts = 1;
    std::optional<double> failAbove;
    Metric metric = Metric::Maximum;
};

// One of the two, as far as it was asked for.
struct LoadedInput {
    openvdb::FloatGrid::Ptr grid;  // null of a mesh
    ComparedSurface surface;
    std::optional<double> voxel;
};

constexpr double kDistanceTolerance = 0.1;

}  // namespace

const CommandTable& compareTable() {
    static const CommandTable table{
        "compare",
        "Tell how far two volumes are from each other, or from a mesh.",
        "Compares the values of two grids, voxel by voxel, and the surfaces that they stand for: "
        "their distance, the angle between their normals, the volume inside. On different "
        "lattices values are compared on that of A, where B is read between its voxels. One of "
        "the two, or both, may be a mesh: then surfaces are compared, the mesh's being that of "
        "the solid that convert would make of it.",
        {{"A",
          "A .vdb file or a mesh; one of the two may be stdin.vdb, the standard input.",
          false,
          {.endings = vdbAndMeshEndings()}},
         {"B", "What it is compared with.", false, {.endings = vdbAndMeshEndings()}}},
        {
            {"grid", 0, "NAME", "density", "The grid to take of .vdb files.", "Comparison"},
            {"iso", 0, "D", "stored, or 0.5",
             "Value that is the surface, in both; 0 of level sets. volume: of each that which "
             "encloses the volume of its source.",
             "Comparison"},
            {"only",
             0,
             "PART",
             "both",
             "values or surfaces: compare no more than these.",
             "Comparison",
             {.words = {"values", "surfaces"}}},
            {"distance-tolerance", 0, "V", formatNumber(kDistanceTolerance),
             "The largest distance is found to within so many voxels, 1e-4 to 10. Between meshes, "
             "in thousandths of the diagonal of their box.",
             "Comparison"},
            {"cuts", 0, "N", "1",
             "How often triangles of a grid's surface are cut into four, with points on the "
             "surface, 0 to 3.",
             "Comparison"},
            {"fail-above", 0, "E", "",
             "End with status 4 if the metric is above E, after printing all.", "Outcome"},
            {"metric",
             0,
             "M",
             "max; hausdorff with a mesh",
             "max or rms (difference of values), hausdorff or mean-distance (world units), volume "
             "or integral (difference in parts of A's), angle (of normals, of which 95 % have "
             "less, degrees).",
             "Outcome",
             {.words = metricNames()}},
            {"json", 0, "", "", "Print JSON instead of words.", "Output"},
        },
        {
            {"bandvox compare before.vdb after.vdb", "All that can be told."},
            {"bandvox compare bunny.vdb bunny.obj", "How well a volume holds a mesh."},
            {"bandvox compare a.vdb b.vdb --only values --fail-above 1e-4",
             "A test: status 4 if a value differs by more."},
        }};
    return table;
}

namespace {

Metric readMetric(const CommandLine& line, bool withMesh) {
    const auto standard = withMesh ? Metric::Hausdorff : Metric::Maximum;
    return static_cast<Metric>(line.choice("metric", static_cast<std::size_t>(standard)));
}

void readFailure(const CommandLine& line, bool withMesh, CompareRequest& request) {
    request.metric = readMetric(line, withMesh);
    if (!line.has("metric") && !request.values) request.metric = Metric::Hausdorff;
    if (!line.has("fail-above")) {
        if (line.has("metric")) {
            throw Error(ErrorKind::Usage,
                        "--metric says what --fail-above is about; expected both");
        }
        return;
    }
    request.failAbove = line.number("fail-above", {.low = 0}, 0);
    const bool isThere = isOfValues(request.metric) ? request.values : request.surfaces;
    if (isThere) return;
    throw Error(ErrorKind::Usage,
                "the metric '" + metricNames()[static_cast<std::size_t>(request.metric)] +
                    (isOfValues(request.metric) ? "' is of values" : "' is of surfaces") +
                    ", which are not compared" +
                    (withMesh && isOfValues(request.metric) ? ": a mesh has none" : ""));
}

CompareRequest parseCompare(const CommandLine& line) {
    CompareRequest request;
    bool withMesh = false;
    for (std::size_t i = 0; i < 2; ++i) {
        request.inputs[i] = line.positional(i);
        const bool isMesh = isMeshFile(request.inputs[i]) && !isPatchFile(request.inputs[i]);
        if (!isMesh) requireVdb("compare", request.inputs[i]);
        withMesh = withMesh || isMesh;
    }
    if (isStandardInput(request.inputs[0]) && isStandardInput(request.inputs[1])) {
        throw Error(ErrorKind::Usage,
                    "stdin.vdb is there twice; the standard input can be one input only");
    }
    request.grid = line.text("grid");
    request.iso = readIso(line, {});
    const std::size_t only = line.choice("only", 2);
    if (only == 0 && withMesh) {
        throw Error(ErrorKind::Usage, "--only values needs two .vdb files; a mesh has no values");
    }
    request.values = only != 1 && !withMesh;
    request.surfaces = only != 0;
    for (const char* name : {"iso", "cuts", "distance-tolerance"}) {
        if (request.surfaces || !line.has(name)) continue;
        throw Error(ErrorKind::Usage, std::string("option --") + name +
                                          " is about surfaces, and --only values leaves them out");
    }
    request.tolerance =
        line.number("distance-tolerance", {.low = 1e-4, .high = 10}, kDistanceTolerance);
    request.cuts = line.wholeNumber("cuts", 0, 3, request.cuts);
    readFailure(line, withMesh, request);
    return request;
}

void loadMesh(CommandRun& run, const std::string& input, LoadedInput& loaded,
              ComparedInput& known) {
    SolidMesh solid = loadSolidMesh(run, input, {});
    Mesh& mesh = loaded.surface.mesh;
    mesh = std::move(solid.solid);
    if (solid.soup.triangles.empty()) {
        known.volume = MeshSource(input, mesh).volume();
        return;
    }
    // Triangles that only a winding number makes a solid of are a surface all the same.
    run.say("surface  of '" + input + "' encloses no volume that could be told");
    const auto first = static_cast<openvdb::Int32>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), solid.soup.points.begin(), solid.soup.points.end());
    for (const openvdb::Vec3I& t : solid.soup.triangles) {
        mesh.triangles.push_back(t + openvdb::Vec3I(first));
    }
}

/// What is wrong with a grid names the input that has it.
SurfaceOfGrid surfaceOf(CommandRun& run, const std::string& input, const CompareRequest& request,
                        const openvdb::FloatGrid::ConstPtr& grid) {
    try {
        return gridToSurface(grid, {.iso = isoFor(run, request.iso, grid), .cuts = request.cuts},
                             run.progress());
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        throw Error(error.kind(), input + ": " + error.what());
    }
}

void loadGrid(CommandRun& run, const std::string& input, const CompareRequest& request,
              LoadedInput& loaded, ComparedInput& known) {
    {
        const ProgressStage stage(run.progress(), "read", 0);
        loaded.grid = chooseFloatGrid(readGrids(input), request.grid, "density", input);
    }
    run.progress().throwIfInterrupted();
    known.grid = loaded.grid->getName();
    run.say("read     " + input + ": grid '" + known.grid + "', " +
            formatCount(static_cast<std::int64_t>(loaded.grid->activeVoxelCount()), "active voxel",
                        "active voxels"));
    if (!request.surfaces) return;
    SurfaceOfGrid made = surfaceOf(run, input, request, loaded.grid);
    known.iso = made.iso;
    known.volume = made.volume;
    loaded.surface = std::move(made.surface);
    loaded.voxel = made.voxel;
    run.say("surface  of '" + input + "': " +
            formatCount(static_cast<std::int64_t>(loaded.surface.mesh.triangles.size()), "triangle",
                        "triangles") +
            ", at most " + formatNumber(loaded.surface.deviation, 3) + " off");
}

void requireOneWorld(const CompareRequest& request, const std::array<LoadedInput, 2>& loaded) {
    if (!loaded[0].grid || !loaded[1].grid) return;
    const std::string place = placeDifference(*loaded[0].grid, *loaded[1].grid);
    if (place.empty()) return;
    throw Error(ErrorKind::Input, "'" + request.inputs[0] + "' and '" + request.inputs[1] +
                                      "' are not in one world: " + place);
}

void compareAll(CommandRun& run, const CompareRequest& request,
                const std::array<LoadedInput, 2>& loaded, ComparisonResult& result) {
    if (request.values) {
        result.values = compareGrids(loaded[0].grid, loaded[1].grid, {}, run.progress());
        const auto isLevelSet = [](const LoadedInput& input) {
            return input.grid->getGridClass() == openvdb::GRID_LEVEL_SET;
        };
        // What a band of distances sums up to means nothing.
        if (!isLevelSet(loaded[0])) result.a.integral = result.values->integralA;
        if (!isLevelSet(loaded[1])) result.b.integral = result.values->integralB;
        run.count("voxels", result.values->voxels);
    }
    if (!request.surfaces) return;
    result.voxel = loaded[0].voxel ? loaded[0].voxel : loaded[1].voxel;
    CompareSurfacesOptions options;
    if (result.voxel) {
        options.tolerance = request.tolerance * *result.voxel;
    } else {
        openvdb::BBoxd box;
        for (const LoadedInput& input : loaded) {
            for (const openvdb::Vec3d& p : input.surface.mesh.points) box.expand(p);
        }
        options.tolerance = request.tolerance * 1e-3 * box.extents().length();
    }
    result.surfaces =
        compareSurfaces(loaded[0].surface, loaded[1].surface, options, run.progress());
    run.count("triangles_a", loaded[0].surface.mesh.triangles.size());
    run.count("triangles_b", loaded[1].surface.mesh.triangles.size());
}

// Nothing if it is not defined, as the volume of a mesh that is not closed.
std::optional<double> measured(const ComparisonResult& result, Metric metric) {
    const auto size = [](const std::optional<double>& number) {
        return number ? std::optional(std::abs(*number)) : std::nullopt;
    };
    switch (metric) {
        case Metric::Maximum:
            return result.values->maximum;
        case Metric::Rms:
            return result.values->rms;
        case Metric::Hausdorff:
            return result.surfaces->hausdorff;
        case Metric::MeanDistance:
            return result.surfaces->meanDistance;
        case Metric::Volume:
            return size(relativeDifference(result.a.volume, result.b.volume));
        case Metric::Integral:
            return size(relativeDifference(result.a.integral, result.b.integral));
        default:
            return result.surfaces->angles.percent95;
    }
}

void failIfAbove(const CompareRequest& request, const ComparisonResult& result) {
    if (!request.failAbove) return;
    const std::string& name = metricNames()[static_cast<std::size_t>(request.metric)];
    const auto found = measured(result, request.metric);
    if (!found) {
        throw Error(ErrorKind::Result, "the metric '" + name + "' is not defined for '" +
                                           result.a.file + "' and '" + result.b.file + "'");
    }
    if (*found <= *request.failAbove) return;
    throw Error(ErrorKind::Result, "the metric '" + name + "' of '" + result.a.file + "' and '" +
                                       result.b.file + "' is " + formatNumber(*found) +
                                       ", above --fail-above " + formatNumber(*request.failAbove));
}

}  // namespace

void runCompare(const CommandLine& line) {
    const CompareRequest request = parseCompare(line);
    CommandRun run(line);
    ComparisonResult result;
    std::array<LoadedInput, 2> loaded;
    for (std::size_t i = 0; i < 2; ++i) {
        ComparedInput& known = i == 0 ? result.a : result.b;
        known.file = request.inputs[i];
        if (isMeshFile(request.inputs[i])) {
            loadMesh(run, request.inputs[i], loaded[i], known);
        } else {
            loadGrid(run, request.inputs[i], request, loaded[i], known);
        }
    }
    requireOneWorld(request, loaded);
    compareAll(run, request, loaded, result);
    run.finish();
    writeResult(line.has("json") ? comparisonReport(result).dump(
                                       2, ' ', false, nlohmann::json::error_handler_t::replace) +
                                       "\n"
                                 : comparisonInWords(result));
    failIfAbove(request, result);
}

}  // namespace bandvox::app
