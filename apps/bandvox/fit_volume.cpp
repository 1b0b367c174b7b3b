#include "fit_volume.h"

#include "command_run.h"
#include "fit_columns.h"
#include "fit_report.h"
#include "mesh_output.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/scatter/fit_volume.h>
#include <bandvox/scatter/read_scattered_points.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bandvox::app {
namespace {

/// What is wanted of each column.
struct VolumeQuantities {
    bool value = true;
    bool gradient = false;
};

struct FitVolumeRequest {
    std::string input;
    PointColumnChoice columns;
    FitVolumeOptions fit;
    bool hasTolerance = false;
    std::filesystem::path output;
    int resolution = DensityOptions().resolution;
    double voxelSize = 0;
    VdbWriteOptions write;
    VolumeQuantities quantities;
};

VolumeQuantities readVolumeQuantities(const CommandLine& line) {
    const auto text = line.text("quantities");
    if (!text) return {};
    VolumeQuantities quantities{false, false};
    for (const std::string_view word : split(*text, ',')) {
        const bool isValue = word == "value";
        bool& wanted = isValue ? quantities.value : quantities.gradient;
        if ((!isValue && word != "gradient") || wanted) {
            line.fail("quantities", "value, gradient, or both with a comma between");
        }
        wanted = true;
    }
    return quantities;
}

FitVolumeRequest parseFitVolume(const CommandLine& line) {
    FitVolumeRequest request;
    request.input = line.positional(0);
    request.output = outputPath(line.requiredText("output"));
    requireExtension(request.output, {".vdb"});
    refuseOptions(line, {"rectangle", "levels", "samples", "base", "cutoff", "order"},
                  "with --volume");
    request.columns.isInSpace = true;
    if (const auto text = line.text("columns")) {
        for (const std::string_view word : split(*text, ',')) {
            request.columns.columns.emplace_back(word);
        }
    }
    FitVolumeOptions& fit = request.fit;
    request.hasTolerance = line.has("tolerance");
    fit.tolerance = line.number("tolerance", {.low = 0, .high = 1}, fit.tolerance);
    if (line.has("smooth")) fit.noise = line.number("smooth", {.low = 0, .lowOpen = true}, 1);
    if (fit.noise > 0) refuseOptions(line, {"tolerance"}, "with --smooth");
    if (line.has("max-level")) fit.maxLevel = line.wholeNumber("max-level", 1, 16, 1);
    if (line.has("reach")) fit.reach = line.number("reach", {.low = 0, .lowOpen = true}, 1);
    fit.tension = line.number("tension", {.low = 0.01, .high = 1e4}, fit.tension);
    readSize(line, request.resolution, request.voxelSize);
    request.write.half = line.has("half");
    request.write.compression = readCompression(line);
    request.quantities = readVolumeQuantities(line);
    return request;
}

void sayVolumeFit(CommandRun& run, const VolumeFit& fit) {
    run.say("fitted   " +
            formatCount(static_cast<std::int64_t>(fit.volume.controlPoints()), "control point",
                        "control points") +
            " within " + formatNumber(fit.volume.reach(), 3) + " of the points; off by " +
            formatNumber(fit.largest, 2) + " of the range at most, " + formatNumber(fit.rms, 2) +
            " in the root of the mean square");
    nlohmann::json levels = nlohmann::json::array();
    for (const VolumeLevel& level : fit.report) {
        run.sayMore("         level " + std::to_string(level.level) + ": " +
                    formatCount(static_cast<std::int64_t>(level.controlPoints), "control point",
                                "control points") +
                    ", off by " + formatNumber(level.largest, 2) + " at most");
        levels.push_back({{"level", level.level},
                          {"control_points", level.controlPoints},
                          {"largest", level.largest},
                          {"rms", level.rms}});
    }
    run.count("control_points", fit.volume.controlPoints());
    run.count("reach", fit.volume.reach());
    run.count("largest", fit.largest);
    run.count("levels", levels);
    sayDuplicates(run, fit.points, fit.duplicates);
}

void judgeVolumeFit(CommandRun& run, const FitVolumeRequest& request, const VolumeFit& fit) {
    if (!fit.noiseReached) {
        std::string message = "no field differs from the values by as much as --smooth says; ";
        message += "this one does by " + formatNumber(fit.rms, 3) + " of the range";
        run.warn({message}, ErrorKind::Result);
    }
    if (request.fit.noise > 0) return;
    judgeResidual(run, {"field", fit.largest, request.fit.tolerance, request.hasTolerance,
                        request.fit.maxLevel.has_value()});
}

std::vector<ColumnGrid> wantedGrids(const FitVolumeRequest& request,
                                    const std::vector<std::string>& names) {
    const std::vector<ColumnGrid> values = gridsOfColumns(names);
    std::vector<ColumnGrid> wanted;
    if (request.quantities.value) wanted = values;
    for (const ColumnGrid& grid : values) {
        if (!request.quantities.gradient) break;
        for (int c = 0; c < grid.columns; ++c) {
            const int column = grid.column + c;
            const std::string name =
                grid.columns == 1 ? grid.name : names[static_cast<std::size_t>(column)];
            ColumnGrid gradient{name + "_gradient", column, 1, openvdb::VEC_COVARIANT};
            gradient.isGradient = true;
            wanted.push_back(gradient);
        }
    }
    return wanted;
}

openvdb::GridPtrVec sampleVolume(CommandRun& run, const FitVolumeRequest& request,
                                 const SplineVolume& volume,
                                 const std::vector<std::string>& names) {
    double voxelSize = request.voxelSize;
    const openvdb::Vec3d size = volume.bounds().extents();
    if (!(voxelSize > 0)) voxelSize = std::max({size[0], size[1], size[2]}) / request.resolution;
    openvdb::GridPtrVec grids =
        splineVolumeToGrids(volume, wantedGrids(request, names), voxelSize, run.progress());
    std::vector<std::string> made;
    for (const auto& grid : grids) {
        setSourceMetadata(*grid, std::filesystem::path(request.input).filename().string());
        grid->insertMeta("bandvox_reach", openvdb::DoubleMetadata(volume.reach()));
        made.push_back(printable(grid->getName()));
    }
    const auto voxels = static_cast<std::int64_t>(grids.front()->activeVoxelCount());
    run.say("sampled  " + joined(made, ", ") + ": " +
            formatCount(voxels, "active voxel", "active voxels") + " of side " +
            formatNumber(voxelSize));
    run.count("active_voxels", voxels);
    return grids;
}

}  // namespace

std::vector<OptionEntry> fitVolumeEntries() {
    const std::string group = "Volume";
    return {
        {"volume", 0, "", "",
         "The places are in space, x y z: the values become grids of a .vdb file, named after "
         "their columns, Cd of columns named r, g and b.",
         group},
        {"reach", 0, "R", "4 times the points' distance, at most half the box",
         "How far from the points there are values, world units; voxels farther off are inactive, "
         "and 0.",
         group},
    };
}

void runFitVolume(const CommandLine& line) {
    const FitVolumeRequest request = parseFitVolume(line);
    CommandRun run(line);
    AtomicFile output(request.output);
    const ScatteredPoints points =
        readScatteredPoints(request.input, request.columns, run.progress());
    sayPoints(run, request.input, points);
    VolumeFit fit;
    {
        const ProgressStage stage(run.progress(), "fitting", 0);
        fit = fitVolume(points, request.fit, run.progress());
    }
    sayVolumeFit(run, fit);
    judgeVolumeFit(run, request, fit);
    const openvdb::GridPtrVec grids = sampleVolume(run, request, fit.volume, points.names);
    run.writeOutput(output, [&](AtomicFile& file) {
        writeVdb(file, {grids.begin(), grids.end()}, request.write);
    });
}

}  // namespace bandvox::app
