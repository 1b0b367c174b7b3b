// bandvox convert for the solid that a volume stands for: a level set's or fog's of other programs,
// binary voxels, or what of a scan is above a threshold.

#include "convert_grid_solid.h"

#include "choose_grid.h"
#include "density_report.h"
#include "mesh_output.h"
#include "solid_output.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/grid/array_to_solid_grid.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/mesh/grid_to_density.h>
#include <bandvox/source/array_source.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace bandvox::app {
namespace {

/// Values from `low` to `high` are inside.
struct Threshold {
    double low = 0;
    double high = std::numeric_limits<double>::infinity();
};

struct GridSolidRequest {
    std::string input;
    std::optional<std::string> grid;
    std::optional<Threshold> threshold;
    StackRequest stack;
    double background = 0;  ///< of an array
    LatticeRequest lattice;
    DensityOptions density;   ///< without a voxel size
    bool isFiltered = false;  ///< a filter was asked for
    bool makesAnew = false;   ///< what only has a meaning where a density is made of a solid was
    SolidOutput output;

    bool isArray() const { return isStackInput(input); }
};

std::optional<Threshold> readThreshold(const CommandLine& line, bool isArray) {
    const auto numbers =
        line.numbers("threshold", 1, 2, "a number, or two with a comma between them");
    if (!numbers) return std::nullopt;
    Threshold threshold;
    threshold.low = numbers->front();
    if (numbers->size() == 2) {
        threshold.high = numbers->back();
        if (!isArray) line.fail("threshold", "one number for a .vdb file");
        if (!(threshold.low < threshold.high)) {
            line.fail("threshold", "the first number to be the lower one");
        }
    }
    return threshold;
}

GridSolidRequest parseGridSolid(const CommandLine& line) {
    GridSolidRequest request;
    request.input = line.positional(0);
    request.output = readSolidOutput(line, "a solid");
    refuseOptions(line,
                  {"route", "oversample", "overlap", "color", "no-filter", "points", "radius"},
                  "for the solid of a volume");
    request.stack = readStackRequest(line, request.input);
    request.threshold = readThreshold(line, request.isArray());
    if (request.isArray()) {
        refuseOptions(line, {"grid"}, "for an array, which has one only");
        if (!request.threshold) {
            throw Error(ErrorKind::Usage, "which values of '" + request.input +
                                              "' are inside of a solid has to be said; expected "
                                              "--threshold");
        }
    } else {
        refuseOptions(line, {"background"}, "for a .vdb file, which says itself what its own is");
    }
    request.grid = line.text("grid");
    request.background = line.number("background", {.low = -1e30, .high = 1e30}, 0);
    request.lattice = readLattice(line);
    request.isFiltered = line.has("cutoff") || line.has("order");
    DensityOptions& density = request.density;
    density.tolerance = line.number("tolerance", {.low = 1e-6, .high = 0.05}, density.tolerance);
    readDensityOptions(line, request.output, density);
    request.makesAnew = line.has("tile") || line.has("clamp");
    return request;
}

/// A grid as a solid.
struct GridSolid {
    openvdb::FloatGrid::Ptr grid;
    std::optional<double> iso;
    std::string name;
};

GridSolid readArraySolid(CommandRun& run, const GridSolidRequest& request) {
    const auto source = openStack(request.input, request.stack);
    for (const std::string& words : arrayInWords(source->info())) run.say(words);
    GridSolid solid;
    solid.grid = arrayToSolidGrid(
        *source, {request.threshold->low, request.threshold->high, request.background},
        run.progress());
    solid.iso = 0;
    solid.name = sourceOf(*solid.grid);
    return solid;
}

// What nothing is has to be outside.
void requireAbove(const openvdb::FloatGrid& grid, double threshold) {
    const double background = grid.background();
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET || threshold > background) return;
    throw Error(ErrorKind::Usage, "option --threshold is " + formatNumber(threshold) +
                                      "; expected a number above the background of the grid '" +
                                      grid.getName() + "', " + formatNumber(background));
}

GridSolid readGridSolid(CommandRun& run, const GridSolidRequest& request) {
    run.say("read     " + request.input);
    if (request.isArray()) return readArraySolid(run, request);
    const openvdb::GridPtrVec grids = readGrids(request.input);
    GridSolid solid;
    if (request.grid) {
        solid.grid = asFloatGrid(chooseGrid(grids, *request.grid, request.input));
    } else if (grids.size() == 1) {
        solid.grid = asFloatGrid(grids.front());
    } else {
        solid.grid = chooseFloatGrid(grids, {}, "density", request.input);
    }
    if (!solid.grid) {
        throw Error(ErrorKind::Input, "'" + request.input +
                                          "' holds no numbers that are inside or outside of a "
                                          "solid; expected a grid of floats, whole numbers or "
                                          "truths");
    }
    if (!request.stack.space.empty()) turnToSpace(*solid.grid, request.stack.space);
    warnOfPart(run, *solid.grid, request.input);
    if (request.threshold) {
        solid.iso = request.threshold->low;
        requireAbove(*solid.grid, *solid.iso);
    }
    solid.name = sourceOf(*solid.grid);
    if (solid.name.empty()) solid.name = std::filesystem::path(request.input).filename().string();
    return solid;
}

/// A density, and what was measured if it was made anew.
struct SolidDensity {
    openvdb::FloatGrid::Ptr grid;
    std::optional<DensityResult> result;
};

// The density of a solid on a lattice of cubes.
DensityResult densityOn(CommandRun& run, const GridSolid& solid,
                        const openvdb::math::Transform& target, const DensityOptions& options) {
    return gridToDensity(solid.grid, target, {options, solid.iso, solid.name}, run.progress());
}

// A density of this library is one already.
openvdb::FloatGrid::Ptr densityOfDensity(CommandRun& run, const GridSolidRequest& request,
                                         const openvdb::FloatGrid::Ptr& grid,
                                         const openvdb::math::Transform& target) {
    if (request.makesAnew) {
        throw Error(ErrorKind::Usage,
                    "--clamp and --tile have no meaning where the input is a density already");
    }
    if (request.lattice.isSame() && !request.isFiltered) {
        if (request.density.shard.isWhole()) return grid;
        throw Error(ErrorKind::Usage,
                    "--shard has no meaning where a density is copied; expected a new lattice");
    }
    ResampleOptions options;
    options.filter = request.density.filter;
    options.tolerance = request.density.tolerance;
    options.shard = request.density.shard;
    return resampleGrid(grid, target, options, run.progress()).grid;
}

SolidDensity makeDensity(CommandRun& run, const GridSolidRequest& request, const GridSolid& solid,
                         const openvdb::GridBase::ConstPtr& onto) {
    if (!request.threshold && isDensityOfSolid(*solid.grid)) {
        return {densityOfDensity(run, request, solid.grid,
                                 *targetFor(*solid.grid, request.lattice, onto)),
                {}};
    }
    DensityResult result =
        densityOn(run, solid, *cubesFor(*solid.grid, request.lattice, onto), request.density);
    return {result.grid, std::move(result)};
}

void finishSolid(CommandRun& run, const GridSolidRequest& request, SolidDensity& density) {
    if (!density.result) {
        DensityMetadata metadata = *densityMetadata(*density.grid);
        return finishDensity(run, request.output, density.grid, metadata);
    }
    DensityResult& result = *density.result;
    finishDensity(run, request.output, density.grid, result.metadata);
    sayDensity(run, result, exactErrorInWords(request.output, result.metadata));
    run.warn(result.warnings, ErrorKind::Result);
}

// A level set or fog of the grid's own lattice needs no density between.
bool isDirect(const GridSolidRequest& request, const GridSolid& solid) {
    return request.output.kind.kind != OutputKind::Kind::Density && !request.isArray() &&
           !request.output.iso.isGiven() && request.lattice.isSame() && !request.isFiltered &&
           solid.grid->hasUniformVoxels();
}

}  // namespace

std::vector<OptionEntry> gridSolidEntries() {
    return {
        {"threshold", 0, "T[,T2]", "",
         "Take a volume as the solid of its values above T, of an array between T and T2. Of a "
         ".vdb file with --as density, level-set or fog that is its own iso-value, else 0.5, and "
         "below 0 of a level set.",
         "Volumes as input"}};
}

bool takesSolidOfGrid(const CommandLine& line) {
    const std::string& input = line.positional(0);
    if (isShape(input) || !(extensionOf(input) == ".vdb" || isStackInput(input))) return false;
    if (!line.has("threshold") && !line.has("as")) return false;
    if (!asksForValues(line)) return true;
    refuseOptions(line, {"threshold"}, "with --as values");
    return false;
}

void convertGridSolid(ConvertJob& job) {
    const GridSolidRequest request = parseGridSolid(job.line());
    if (!job.begin()) return;
    CommandRun& run = job.run();
    std::optional<AtomicFile> file = request.output.openFile();
    const auto onto = readOnto(request.lattice);
    GridSolid solid = readGridSolid(run, request);
    if (isDirect(request, solid)) {
        const SolidOutput& output = request.output;
        const auto grid = makeOutput(run, output.kind, solid.grid, solid.iso);
        if (output.array) return output.array->write(run, *grid);
        return job.writeVolume(*file, {grid}, output.write);
    }

    SolidDensity density = makeDensity(run, request, solid, onto);
    solid.grid.reset();
    finishSolid(run, request, density);
    writeSolid(job, file, request.output, request.density, density.grid);
}

openvdb::FloatGrid::Ptr rebuildLevelSet(CommandRun& run, const openvdb::FloatGrid::Ptr& levelSet,
                                        const RebuildRequest& request) {
    GridSolid solid{levelSet, {}, levelSet->getName()};
    const double voxel = levelSet->voxelSize()[0];
    OutputKind kind{OutputKind::Kind::LevelSet,
                    std::clamp(std::round(levelSet->background() / voxel), 1.0, 100.0)};
    DensityOptions options;
    options.filter = request.resample.filter.value();
    options.tolerance = request.resample.tolerance;
    DensityResult density =
        densityOn(run, solid, *cubesFor(*levelSet, request.lattice, request.onto), options);
    run.warn(density.warnings, ErrorKind::Result);
    setDensityMetadata(*density.grid, density.metadata);
    auto result = makeOutput(run, kind, density.grid);
    result->setName(levelSet->getName());
    return result;
}

}  // namespace bandvox::app
