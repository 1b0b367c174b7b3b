// bandvox convert for the solid that a volume stands for: a level set's or fog's of other programs,
// binary voxels, or what of a scan is above a threshold.

#include "convert_grid_solid.h"

#include "choose_grid.h"
#include "convert_to_array.h"
#include "convert_volume.h"
#include "density_report.h"
#include "iso_option.h"
#include "mesh_output.h"
#include "output_kind.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/grid/array_to_solid_grid.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/grid_surface.h>
#include <bandvox/resample/detail_levels.h>
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

constexpr int kLargestGridTile = 512;

/// Values from `low` to `high` are inside.
struct Threshold {
    double low = 0;
    double high = std::numeric_limits<double>::infinity();
};

struct GridSolidRequest {
    std::string input;
    std::filesystem::path output;
    std::optional<MeshOutput> mesh;      ///< instead of a volume
    std::unique_ptr<ArrayOutput> array;  ///< the same
    std::optional<std::string> grid;
    std::optional<Threshold> threshold;
    StackRequest stack;
    double background = 0;  ///< of an array
    LatticeRequest lattice;
    DensityOptions density;   ///< without a voxel size
    bool isFiltered = false;  ///< a filter was asked for
    IsoOption iso;
    OutputKind kind;
    int levels = 0;
    VdbWriteOptions write;

    bool isArray() const { return isStackInput(input); }
};

std::optional<Threshold> readThreshold(const CommandLine& line, bool isArray) {
    const auto text = line.text("threshold");
    if (!text) return std::nullopt;
    const auto parts = split(*text, ',');
    OptionValues values;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        values.set(i == 0 ? "low" : "high", std::string(parts[i]));
    }
    const auto number = [&](const char* name) {
        try {
            return values.number(name, {}, 0);
        } catch (const Error&) {
            line.fail("threshold", "a number, or two with a comma between them");
        }
    };
    Threshold threshold;
    if (parts.empty() || parts.size() > 2) {
        line.fail("threshold", "a number, or two with a comma between them");
    }
    threshold.low = number("low");
    if (parts.size() == 2) {
        threshold.high = number("high");
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
    const std::string output = line.requiredText("output");
    request.array = ArrayOutput::read(line);
    if (!request.array) request.mesh = readVdbOrMeshOutput(line);
    request.output = outputPath(output);
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
    density.filter = readFilter(line, density.filter);
    density.tolerance = line.number("tolerance", {.low = 1e-6, .high = 0.05}, density.tolerance);
    density.tile = line.wholeNumber("tile", 0, kLargestGridTile, density.tile);
    if (density.tile % 2 != 0) line.fail("tile", "an even number");
    density.clamp = line.has("clamp");
    request.iso = readIso(line, {.low = 0, .high = 1, .lowOpen = true, .highOpen = true});
    density.iso = request.iso.value.value_or(density.iso);
    request.kind = readOutputKind(line).value_or(OutputKind());
    request.levels = readDetailLevels(line);
    density.shard = readShard(line);
    if (!density.shard.isWhole() && request.kind.kind != OutputKind::Kind::Density) {
        throw Error(ErrorKind::Usage,
                    "--as level-set or fog needs the whole, and --shard asks for "
                    "a part; convert what is merged");
    }
    request.write.half = line.has("half");
    if (!request.array) request.write.compression = readCompression(line);
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
    if (request.threshold) solid.iso = request.threshold->low;
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
                        const openvdb::math::Transform& target, DensityOptions options) {
    // The lattice upright, and its voxel 0 at the origin: then index i lies at i·Δ.
    const double side = target.voxelSize()[0];
    openvdb::Mat4d toLattice = target.baseMap()->getAffineMap()->getMat4().inverse();
    toLattice.postScale(openvdb::Vec3d(side));
    options.voxelSize = side;
    const auto source =
        makeGridSurface(solid.name, solid.grid, {solid.iso, toLattice}, run.progress());
    DensityResult result = surfaceToDensity(*source, options, run.progress());
    result.grid->setTransform(target.copy());
    const auto space = solid.grid->getMetadata<openvdb::StringMetadata>("bandvox_space");
    if (space) result.grid->insertMeta("bandvox_space", *space);
    return result;
}

// A density of this library is one already.
openvdb::FloatGrid::Ptr densityOfDensity(CommandRun& run, const GridSolidRequest& request,
                                         const openvdb::FloatGrid::Ptr& grid,
                                         const openvdb::math::Transform& target) {
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
                         const openvdb::math::Transform::ConstPtr& onto) {
    if (!request.threshold && densityMetadata(*solid.grid)) {
        return {densityOfDensity(run, request, solid.grid,
                                 *targetFor(*solid.grid, request.lattice, onto)),
                {}};
    }
    DensityResult result =
        densityOn(run, solid, *cubesFor(*solid.grid, request.lattice, onto), request.density);
    return {result.grid, std::move(result)};
}

// What is said, stored and rounded of a density.
void finishDensity(CommandRun& run, const GridSolidRequest& request, SolidDensity& density) {
    const auto before = density.result ? density.result->metadata : *densityMetadata(*density.grid);
    DensityMetadata metadata = before;
    if (request.write.half) {
        metadata.storageError = std::max(metadata.storageError, roundToHalf(*density.grid));
        metadata.gridVolume = densityIntegral(*density.grid);
    }
    setDensityMetadata(*density.grid, metadata);
    if (const auto iso = isoFor(run, request.iso, density.grid)) metadata.iso = *iso;
    setDensityMetadata(*density.grid, metadata);
    if (!density.result) return;
    density.result->metadata = metadata;
    sayDensity(run, *density.result,
               formatNumber(metadata.closureError, 2) + " measured by closure, tolerance " +
                   formatNumber(metadata.tolerance, 2));
    run.warn(density.result->warnings, ErrorKind::Result);
}

// A level set or fog of the grid's own lattice needs no density between.
bool isDirect(const GridSolidRequest& request, const GridSolid& solid) {
    return request.kind.kind != OutputKind::Kind::Density && !request.isArray() &&
           request.lattice.isSame() && !request.isFiltered && solid.grid->hasUniformVoxels();
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
    std::optional<AtomicFile> output;
    if (!request.array) output.emplace(request.output);
    const auto onto = readOnto(request.lattice);
    GridSolid solid = readGridSolid(run, request);
    if (isDirect(request, solid)) {
        const auto grid = makeOutput(run, request.kind, solid.grid, solid.iso);
        if (request.array) return request.array->write(run, *grid);
        return job.writeVolume(*output, {grid}, request.write);
    }

    SolidDensity density = makeDensity(run, request, solid, onto);
    solid.grid.reset();
    finishDensity(run, request, density);
    if (request.mesh) return writeMeshOutput(job, *output, *request.mesh, density.grid, nullptr);
    const auto made = makeOutput(run, request.kind, density.grid);
    if (request.array) return request.array->write(run, *made);
    openvdb::GridCPtrVec written{made};
    if (request.levels > 0) {
        ResampleOptions options;
        options.filter = request.density.filter;
        options.tolerance = request.density.tolerance;
        for (const auto& level :
             makeDetailLevels(density.grid, request.levels, options, run.progress())) {
            if (request.write.half) roundToHalf(*level);
            written.push_back(level);
        }
    }
    job.writeVolume(*output, written, request.write);
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
