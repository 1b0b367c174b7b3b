// bandvox convert for a .vdb file or an array: its grids, filtered and on another lattice if that
// is asked for.

#include "convert_volume.h"

#include "choose_grid.h"
#include "command_run.h"
#include "convert_grid_solid.h"
#include "convert_to_array.h"
#include "iso_option.h"
#include "lattice_request.h"
#include "mesh_output.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/grid/array_to_grid.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/resample/detail_levels.h>
#include <bandvox/resample/resample_grid.h>
#include <bandvox/resample/resample_vectors.h>
#include <bandvox/source/array_source.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace bandvox::app {
namespace {

constexpr int kMostLevels = 16;

// Options that say how a solid becomes a density.
const char* const kOfSolids[] = {"route", "oversample", "overlap", "clamp", "color", "tile"};

struct VolumeRequest {
    std::string input;
    std::filesystem::path output;
    std::optional<std::string> grid;
    LatticeRequest lattice;
    float background = 0;  // of an array
    bool resamples = false;
    ResampleOptions resample;
    IsoOption iso;
    int levels = 0;
    StackRequest stack;
    std::unique_ptr<ArrayOutput> array;  // instead of a .vdb file
    VdbWriteOptions write;
};

VolumeRequest parseVolume(const CommandLine& line) {
    VolumeRequest request;
    request.input = line.positional(0);
    const std::string output = line.requiredText("output");
    request.array = ArrayOutput::read(line);
    if (!request.array && readVdbOrMeshOutput(line)) {
        throw Error(ErrorKind::Usage, "a mesh is made of a .vdb file, and '" + request.input +
                                          "' is an array; convert it to a .vdb file first");
    }
    request.output = outputPath(output);
    for (const char* name : kOfSolids) {
        if (!line.has(name)) continue;
        throw Error(ErrorKind::Usage, std::string("option --") + name +
                                          " is for meshes and shapes, and '" + request.input +
                                          "' is a volume already");
    }
    refuseOptions(line, {"band", "points", "radius"}, "with the values of a volume");
    request.grid = line.text("grid");
    request.stack = readStackRequest(line, request.input);
    if (line.has("background") && !isStackInput(request.input)) {
        throw Error(ErrorKind::Usage, "--background is for arrays, and '" + request.input +
                                          "' says itself what its own is");
    }
    request.background =
        static_cast<float>(line.number("background", {.low = -1e30, .high = 1e30}, 0));
    request.lattice = readLattice(line);
    const bool filters = line.has("cutoff") || line.has("order");
    if (line.has("no-filter")) {
        if (filters) throw Error(ErrorKind::Usage, "--no-filter and a filter exclude each other");
        if (request.lattice.isSame()) {
            throw Error(ErrorKind::Usage,
                        "--no-filter needs another lattice; expected --voxel-size, --factor, "
                        "--resolution or --onto with it");
        }
        request.resample.filter.reset();
    } else {
        request.resample.filter = readFilter(line);
    }
    request.resample.tolerance =
        line.number("tolerance", {.low = 1e-6, .high = 0.05}, request.resample.tolerance);
    request.resamples = filters || !request.lattice.isSame();
    request.iso = readIso(line, {});
    request.levels = readDetailLevels(line);
    request.resample.shard = readShard(line);
    if (!request.resample.shard.isWhole() && !request.resamples) {
        throw Error(ErrorKind::Usage,
                    "--shard has no meaning where grids are copied; expected a new lattice");
    }
    request.write.half = line.has("half");
    if (!request.array) request.write.compression = readCompression(line);
    return request;
}

void sayGrid(CommandRun& run, const openvdb::GridBase& grid) {
    run.say("grid     " + grid.getName() + ": " +
            formatSize(grid.evalActiveVoxelBoundingBox().dim()) + " voxels of side " +
            formatNumber(grid.voxelSize().x()) + ", " +
            formatCount(static_cast<std::int64_t>(grid.activeVoxelCount()), "active voxel",
                        "active voxels"));
}

// A level set and its levels of detail, each that of the solid filtered for its lattice.
openvdb::GridPtrVec convertLevelSet(CommandRun& run, const VolumeRequest& request,
                                    const openvdb::FloatGrid::Ptr& grid,
                                    const openvdb::GridBase::ConstPtr& onto) {
    if (!request.resample.shard.isWhole()) {
        throw Error(ErrorKind::Usage, "--shard has no meaning for the level set '" +
                                          grid->getName() + "', which is rebuilt as a whole");
    }
    openvdb::FloatGrid::Ptr first = grid;
    if (request.resamples) {
        first = rebuildLevelSet(run, grid, {request.lattice, onto, request.resample});
    }
    openvdb::GridPtrVec result{first};
    for (int level = 1; level <= request.levels; ++level) {
        LatticeRequest coarser;
        coarser.factor = std::ldexp(1.0, level);
        const auto lattice = openvdb::FloatGrid::create();
        lattice->setTransform(targetFor(*first, coarser, nullptr));
        const auto made = rebuildLevelSet(run, grid, {coarser, lattice, request.resample});
        nameDetailLevel(*made, *first, level);
        result.push_back(made);
    }
    return result;
}

struct VectorTarget {
    const openvdb::math::Transform& lattice;
    const ResampleOptions& options;
};

openvdb::GridPtrVec convertVectors(CommandRun& run, const VolumeRequest& request,
                                   const openvdb::Vec3SGrid::Ptr& grid,
                                   const VectorTarget& target) {
    openvdb::Vec3SGrid::Ptr first = grid;
    if (request.resamples) {
        first = resampleVectors(grid, target.lattice, target.options, run.progress());
    }
    openvdb::GridPtrVec result{first};
    if (request.levels == 0) return result;
    const auto levels = makeDetailLevels(first, request.levels, target.options, run.progress());
    result.insert(result.end(), levels.begin(), levels.end());
    return result;
}

// The grids that are written for one that is read; none if it is of a type that cannot be filtered.
openvdb::GridPtrVec convertGrid(CommandRun& run, const VolumeRequest& request,
                                const openvdb::GridBase::Ptr& grid,
                                const openvdb::GridBase::ConstPtr& onto) {
    openvdb::GridPtrVec result;
    const Shard& shard = request.resample.shard;
    if (grid->activeVoxelCount() == 0 || (!request.resamples && request.levels == 0)) {
        if (shard.index > 1) return {};
        return {grid};
    }
    warnOfPart(run, *grid, request.input);
    const auto target = targetFor(*grid, request.lattice, onto);
    if (const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid)) {
        // They are made whole, by the first machine.
        if (shard.index > 1) return {};
        ResampleOptions whole = request.resample;
        whole.shard = {};
        return convertVectors(run, request, vectors, {*target, whole});
    }
    openvdb::FloatGrid::Ptr floats = asFloatGrid(grid);
    // Filtered distances are none; those of the filtered solid are.
    if (floats && floats->getGridClass() == openvdb::GRID_LEVEL_SET && request.resample.filter) {
        return convertLevelSet(run, request, floats, onto);
    }
    if (floats && !grid->isType<openvdb::FloatGrid>()) {
        run.say("grid     '" + grid->getName() + "' of type " + grid->valueType() +
                " becomes one of floats");
    }
    if (!floats) {
        run.warn({"the grid '" + grid->getName() + "' of type " + grid->valueType() +
                  " was left away: it cannot be filtered"},
                 ErrorKind::Result);
        return {};
    }
    if (request.resamples) {
        floats = resampleGrid(floats, *target, request.resample, run.progress()).grid;
    }
    result.push_back(floats);
    if (request.levels > 0) {
        for (const auto& level :
             makeDetailLevels(floats, request.levels, request.resample, run.progress())) {
            result.push_back(level);
        }
    }
    return result;
}

// The grid that an array is.
openvdb::FloatGrid::Ptr readArray(CommandRun& run, const VolumeRequest& request) {
    const auto source = openStack(request.input, request.stack);
    for (const std::string& words : arrayInWords(source->info())) run.say(words);
    return arrayToGrid(*source, {request.background, 0}, run.progress());
}

// Levels of detail that a file has already are made anew.
void leaveLevelsAway(CommandRun& run, openvdb::GridPtrVec& grids) {
    const auto isLevel = [&](const openvdb::GridBase::Ptr& grid) {
        const std::string name = grid->getName();
        const std::size_t mark = name.rfind("_level_");
        if (mark == std::string::npos || !(*grid)["MultiResGrid_Level"]) return false;
        return std::any_of(grids.begin(), grids.end(), [&](const openvdb::GridBase::Ptr& other) {
            return other->getName() == name.substr(0, mark);
        });
    };
    openvdb::GridPtrVec kept;
    std::copy_if(grids.begin(), grids.end(), std::back_inserter(kept),
                 [&](const openvdb::GridBase::Ptr& grid) { return !isLevel(grid); });
    if (kept.size() < grids.size()) {
        run.say("levels   " +
                formatCount(static_cast<std::int64_t>(grids.size() - kept.size()), "grid is",
                            "grids are") +
                " left away, which levels that are made anew replace");
    }
    grids = std::move(kept);
}

// Brings grids to another space of scans.
void turnAll(CommandRun& run, const openvdb::GridPtrVec& grids, const std::string& space) {
    for (const openvdb::GridBase::Ptr& grid : grids) {
        turnToSpace(*grid, space);
        if (!grid->isType<openvdb::Vec3SGrid>() || grid->getName().starts_with("Cd")) continue;
        run.warn({"the vectors of the grid '" + grid->getName() +
                  "' were left as they are: it says of them that they do not turn with the world"},
                 ErrorKind::Input);
    }
}

// The grids of the file that are asked for.
openvdb::GridPtrVec readChosen(CommandRun& run, const VolumeRequest& request) {
    if (isStackInput(request.input)) {
        if (request.grid) {
            throw Error(ErrorKind::Usage,
                        "--grid is for .vdb files, and '" + request.input + "' is none");
        }
        return {readArray(run, request)};
    }
    openvdb::GridPtrVec grids = readGrids(request.input);
    if (grids.empty()) {
        throw Error(ErrorKind::Input,
                    "'" + request.input + "' has no grids; expected one at least");
    }
    if (request.array) {
        grids = {chooseFloatGrid(grids, request.grid, "density", request.input)};
    } else if (request.grid) {
        grids = {chooseGrid(grids, *request.grid, request.input)};
    }
    if (request.levels > 0) leaveLevelsAway(run, grids);
    if (!request.stack.space.empty()) turnAll(run, grids, request.stack.space);
    return grids;
}

// What can be known of it before the work.
void requireIsoHasMeaning(const VolumeRequest& request, const openvdb::GridPtrVec& grids) {
    const bool areLevelSets = std::all_of(grids.begin(), grids.end(), [](const auto& grid) {
        return grid->getGridClass() == openvdb::GRID_LEVEL_SET;
    });
    if (!request.iso.isGiven() || !areLevelSets) return;
    throw Error(ErrorKind::Usage,
                "--iso is stored with densities, and '" + request.input +
                    "' holds level sets, whose surface is 0; expected --as level-set with it, for "
                    "that of a density made of them");
}

// Vectors are made whole, by the first machine; of them alone there is nothing to divide.
void requireParts(const VolumeRequest& request, const openvdb::GridPtrVec& grids) {
    const bool areVectors = std::all_of(grids.begin(), grids.end(), [](const auto& grid) {
        return grid->template isType<openvdb::Vec3SGrid>();
    });
    if (request.resample.shard.isWhole() || !areVectors) return;
    throw Error(ErrorKind::Usage, "--shard divides grids of numbers, and '" + request.input +
                                      "' holds vectors only, which are made whole");
}

void setIso(openvdb::GridBase& grid, double iso) {
    if (auto metadata = densityMetadata(grid)) {
        metadata->iso = iso;
        setDensityMetadata(grid, *metadata);
    }
}

// Rounds to 16 bits, if that is asked for, and says so in the grid. True if it is a density, which
// has an iso-value.
bool finishGrid(CommandRun& run, const openvdb::GridBase::Ptr& converted,
                const VolumeRequest& request) {
    openvdb::GridBase& grid = *converted;
    const bool isDensity = densityMetadata(grid).has_value();
    if (isDensity) {
        const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(converted);
        if (const auto iso = isoFor(run, request.iso, density)) setIso(grid, *iso);
    }
    auto* floats = dynamic_cast<openvdb::FloatGrid*>(&grid);
    if (floats && request.write.half) roundAndRestate(*floats);
    return isDensity;
}

}  // namespace

std::vector<OptionEntry> latticeEntries() {
    const std::string lattice = "Volumes as input";
    return {
        {"grid", 0, "NAME", "all", "The grid to take.", lattice},
        {"background", 0, "V", "0",
         "Of an array (.npy, .nrrd, .mha, ...), the value that is nothing, and not stored.",
         lattice},
        {"factor", 0, "S", "1",
         "Make voxels S times as large. --voxel-size and --resolution make them cubes.", lattice},
        {"onto",
         0,
         "FILE",
         "",
         "Take the lattice of the first grid of another file.",
         lattice,
         {.endings = {".vdb"}}},
        {"no-filter", 0, "", "",
         "Only read the grid between its nodes. Otherwise it is filtered for its new lattice: of a "
         "density that is band-limited already, by what is missing.",
         lattice},
        {"lod", 0, "L", "0",
         "Write L levels of detail beside each grid, each with voxels twice as large.", "Output"},
    };
}

int readDetailLevels(const CommandLine& line) {
    return line.wholeNumber("lod", 0, kMostLevels, 0);
}

void convertVolume(ConvertJob& job) {
    const VolumeRequest request = parseVolume(job.line());
    if (!job.begin()) return;
    CommandRun& run = job.run();
    std::optional<AtomicFile> output;
    if (!request.array) output.emplace(request.output);
    const openvdb::GridBase::ConstPtr onto = readOnto(request.lattice);
    run.say("read     " + request.input);
    openvdb::GridPtrVec grids = readChosen(run, request);

    requireIsoHasMeaning(request, grids);
    requireParts(request, grids);

    openvdb::GridCPtrVec written;
    std::int64_t activeVoxels = 0;
    bool isoIsStored = false;
    for (openvdb::GridBase::Ptr& grid : grids) {
        for (const auto& converted : convertGrid(run, request, grid, onto)) {
            isoIsStored = finishGrid(run, converted, request) || isoIsStored;
            sayGrid(run, *converted);
            activeVoxels += static_cast<std::int64_t>(converted->activeVoxelCount());
            written.push_back(converted);
        }
        grid.reset();
    }
    if (request.iso.isGiven() && !isoIsStored) {
        throw Error(ErrorKind::Usage,
                    "--iso is stored with densities, and '" + request.input +
                        "' holds none that says what it is; give it to the commands that come "
                        "after");
    }
    run.count("grids", written.size());
    run.count("active_voxels", activeVoxels);
    if (activeVoxels == 0 && request.resample.shard.isWhole()) {
        throw Error(ErrorKind::Result, "nothing would be written: no grid of '" + request.input +
                                           "' has active voxels that are left");
    }
    if (request.array) {
        return request.array->write(run, dynamic_cast<const openvdb::FloatGrid&>(*written.front()));
    }
    job.writeVolume(*output, written, request.write);
}

}  // namespace bandvox::app
