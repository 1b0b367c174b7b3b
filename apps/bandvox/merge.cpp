// bandvox merge: the densities of several .vdb files in one.

#include "choose_grid.h"
#include "command_run.h"
#include "commands.h"
#include "merge_shards.h"
#include "mesh_output.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "volume_options.h"
#include "words.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/grid/merge_grids.h>
#include <bandvox/grid/same_lattice.h>
#include <bandvox/resample/resample_grid.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace bandvox::app {

const CommandTable& mergeTable() {
    static const CommandTable table{
        "merge",
        "Merge the densities of .vdb files: their union, sum, difference, ...",
        "Merges the densities of several .vdb files on the lattice of the first. Sums and blends "
        "of band-limited densities are what the filtered sum would be. The others are, except "
        "within a filter's width of where two surfaces meet; the maximum has kinks there that no "
        "lattice holds. Other grids of the files, as colours, are left away, and said so. Of parts "
        "that convert --shard has made all together become what one machine would have made.",
        {{"A.vdb",
          "A .vdb file, whose lattice the result has; one input may be stdin.vdb, the "
          "standard input.",
          false,
          {.endings = {".vdb"}}},
         {"B.vdb", "More of them.", true, {.endings = {".vdb"}}}},
        {
            {"operation",
             0,
             "KIND",
             "union",
             "union: a + b - ab. sum: a + b. max. blend: the mean. difference: a (1 - b), the "
             "first without the others. intersection: ab.",
             "Merging",
             {.words = {"union", "sum", "max", "blend", "difference", "intersection"}}},
            {"weights", 0, "W,W,...", "1 each", "Weights of a sum or a blend, one for each input.",
             "Merging"},
            {"clamp", 0, "", "", "Limit the result to 0 .. 1, as of a sum of parts that overlap.",
             "Merging"},
            {"grid", 0, "NAME", "density", "The grid to take of each file.", "Merging"},
            {"resample", 0, "", "",
             "Bring what is on another lattice to that of the first, filtered for it as by "
             "convert --onto. Otherwise lattices may be whole voxels apart, no more.",
             "Merging"},
            vdbOutputEntry(),
            {"half", 0, "", "",
             "Store 16-bit values, which changes densities by up to 2.5e-4, above 1 by 5e-4.",
             "Output"},
            compressionEntry(),
        },
        {
            {"bandvox merge body.vdb hat.vdb -o both.vdb", "The union of two solids."},
            {"bandvox merge part1.vdb part2.vdb part3.vdb -o whole.vdb",
             "The parts of bandvox convert ... --shard 1/3, 2/3 and 3/3."},
            {"bandvox merge block.vdb drill.vdb -o part.vdb --operation difference --resample",
             "A solid without another, which is on a lattice of its own."},
            {"bandvox merge a.vdb b.vdb -o between.vdb --operation blend --weights 3,1",
             "Three parts of one density, and one of the other."},
        }};
    return table;
}

namespace {

struct MergeRequest {
    std::vector<std::string> inputs;
    std::filesystem::path output;
    std::optional<std::string> grid;
    bool resamples = false;
    MergeOptions merge;
    VdbWriteOptions write;
};

std::vector<double> readWeights(const CommandLine& line, std::size_t inputs) {
    const std::string expected =
        formatCount(static_cast<std::int64_t>(inputs), "number", "numbers") +
        " from -1e6 to 1e6 separated by commas, one for each input";
    return line.numbers("weights", inputs, inputs, expected, {.low = -1e6, .high = 1e6})
        .value_or(std::vector<double>());
}

MergeRequest parseMerge(const CommandLine& line) {
    MergeRequest request;
    request.inputs = line.positionals();
    for (const std::string& input : request.inputs) requireVdb("merge", input);
    if (std::count_if(request.inputs.begin(), request.inputs.end(), isStandardInput) > 1) {
        throw Error(ErrorKind::Usage,
                    "stdin.vdb is there more than once; the standard input can be one input only");
    }
    request.output = outputPath(line.requiredText("output"));
    requireExtension(request.output, {".vdb"});
    request.grid = line.text("grid");
    request.resamples = line.has("resample");
    request.merge.operation = static_cast<MergeOperation>(line.choice("operation", 0));
    request.merge.weights = readWeights(line, request.inputs.size());
    request.merge.clamp = line.has("clamp");
    request.write.half = line.has("half");
    request.write.compression = readCompression(line);
    return request;
}

openvdb::GridPtrVec readFile(CommandRun& run, const std::string& input) {
    const ProgressStage stage(run.progress(), "read", 0);
    openvdb::GridPtrVec grids = readGrids(input);
    run.progress().throwIfInterrupted();
    return grids;
}

openvdb::FloatGrid::Ptr chooseDensity(CommandRun& run, const openvdb::GridPtrVec& grids,
                                      const std::string& input, const MergeRequest& request) {
    openvdb::FloatGrid::Ptr grid = chooseFloatGrid(grids, request.grid, "density", input);
    run.say("read     " + input + ": grid '" + grid->getName() + "', " +
            formatCount(static_cast<std::int64_t>(grid->activeVoxelCount()), "active voxel",
                        "active voxels"));
    if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) {
        throw Error(ErrorKind::Input, "the grid '" + grid->getName() + "' of '" + input +
                                          "' is a level set; make a density of it first: bandvox "
                                          "convert " +
                                          shellWord(input) + " -o ... --as density");
    }
    std::vector<std::string> left;
    for (const auto& other : grids) {
        if (other != grid && other->getName() != grid->getName()) {
            left.push_back("'" + other->getName() + "'");
        }
    }
    if (!left.empty()) {
        run.warn({"of '" + input + "' only the grid '" + grid->getName() +
                  "' is merged; left away: " + joined(left, ", ")},
                 ErrorKind::Result);
    }
    return grid;
}

// Throws unless a grid may lie in one world with all that were read before it.
void requireOneWorld(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                     const openvdb::FloatGrid& grid, const MergeRequest& request) {
    for (std::size_t i = 0; i < grids.size(); ++i) {
        const std::string place = placeDifference(*grids[i], grid);
        if (place.empty()) continue;
        throw Error(ErrorKind::Input, "'" + request.inputs[i] + "' and '" +
                                          request.inputs[grids.size()] +
                                          "' are not in one world: " + place);
    }
}

// The grid on the lattice of the first.
openvdb::FloatGrid::ConstPtr alignedTo(CommandRun& run, const openvdb::FloatGrid& first,
                                       const openvdb::FloatGrid::ConstPtr& grid,
                                       const std::string& input, const MergeRequest& request) {
    const std::string difference = latticeDifference(first.transform(), grid->transform());
    if (difference.empty()) return grid;
    if (!request.resamples) {
        throw Error(ErrorKind::Input,
                    "'" + input + "' is on another lattice than '" + request.inputs[0] + "': " +
                        difference + "; bring it there by --resample, or by bandvox convert " +
                        shellWord(input) + " -o ... --onto " + shellWord(request.inputs[0]));
    }
    run.say("resample " + input + ": " + difference);
    ResampleOptions options;
    // What is on the new lattice should be as it would have been made there: as the first was.
    if (const auto metadata = densityMetadata(first)) {
        options.filter = ExponentialFilter{metadata->order, metadata->cutoff};
    }
    return resampleGrid(grid, first.transform(), options, run.progress()).grid;
}

// Rounds to 16 bits, if that is asked for, and says so in the grid.
void roundMerged(openvdb::FloatGrid& grid) {
    const double change = roundToHalf(grid);
    auto metadata = densityMetadata(grid);
    if (!metadata) return;
    metadata->storageError += change;
    metadata->gridVolume = densityIntegral(grid);
    setDensityMetadata(grid, *metadata);
}

// Joins parts, which say themselves what they are parts of.
void runJoin(CommandRun& run, const CommandLine& line, const MergeRequest& request,
             openvdb::GridPtrVec& first, AtomicFile& output) {
    refuseOptions(line, {"operation", "weights", "clamp", "grid", "resample", "half"},
                  "where parts are joined that convert --shard has made");
    VdbWriteOptions write = request.write;
    write.half = std::any_of(first.begin(), first.end(), [](const openvdb::GridBase::Ptr& grid) {
        return grid->saveFloatAsHalf();
    });
    const openvdb::GridCPtrVec written = joinShardFiles(run, request.inputs, first);
    first.clear();
    run.writeOutput(output, [&](AtomicFile& file) { writeVdb(file, written, write); });
}

}  // namespace

void runMerge(const CommandLine& line) {
    const MergeRequest request = parseMerge(line);
    CommandRun run(line);
    AtomicFile output(request.output);
    openvdb::GridPtrVec read = readFile(run, request.inputs[0]);
    if (holdsShard(read)) return runJoin(run, line, request, read, output);
    std::vector<openvdb::FloatGrid::ConstPtr> grids;
    for (const std::string& input : request.inputs) {
        if (!grids.empty()) read = readFile(run, input);
        if (holdsShard(read)) {
            throw Error(ErrorKind::Input, "'" + input + "' holds a part of a larger grid, and '" +
                                              request.inputs[0] +
                                              "' does not; join the parts first, by themselves");
        }
        openvdb::FloatGrid::ConstPtr grid = chooseDensity(run, read, input, request);
        read.clear();
        requireOneWorld(grids, *grid, request);
        if (!grids.empty()) grid = alignedTo(run, *grids.front(), grid, input, request);
        grids.push_back(grid);
    }

    MergeResult result = mergeGrids(grids, request.merge, run.progress());
    grids.clear();
    run.warn(result.warnings, ErrorKind::Input);
    if (request.write.half) roundMerged(*result.grid);
    const auto active = static_cast<std::int64_t>(result.grid->activeVoxelCount());
    run.say("merged   " + nameOf(request.merge.operation) + " of " +
            formatCount(static_cast<std::int64_t>(request.inputs.size()), "grid", "grids") + ": " +
            formatCount(active, "active voxel", "active voxels") + ", integral " +
            formatNumber(densityIntegral(*result.grid)));
    run.count("grids", request.inputs.size());
    run.count("active_voxels", active);
    run.writeOutput(output,
                    [&](AtomicFile& file) { writeVdb(file, {result.grid}, request.write); });
}

}  // namespace bandvox::app
