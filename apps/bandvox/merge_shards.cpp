// bandvox merge for the parts that convert --shard has made: the whole that one machine would have
// made.

#include "merge_shards.h"

#include "standard_streams.h"
#include "words.h"

#include <bandvox/grid/join_shards.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace bandvox::app {
namespace {

/// The parts of one grid.
struct Parts {
    std::string grid;
    std::vector<openvdb::GridBase::Ptr> parts;
    std::vector<std::string> files;
};

/// What the files hold.
struct Gathered {
    std::vector<Parts> parts;
    openvdb::GridCPtrVec whole;
};

void gather(const openvdb::GridPtrVec& grids, const std::string& file, Gathered& gathered) {
    for (const auto& grid : grids) {
        if (!shardMetadata(*grid)) {
            gathered.whole.push_back(grid);
            continue;
        }
        const auto same = [&](const Parts& parts) { return parts.grid == grid->getName(); };
        auto found = std::find_if(gathered.parts.begin(), gathered.parts.end(), same);
        if (found == gathered.parts.end()) {
            gathered.parts.push_back({grid->getName(), {}, {}});
            found = gathered.parts.end() - 1;
        }
        found->parts.push_back(grid);
        found->files.push_back("'" + file + "'");
    }
}

// A grid that is no part comes from one machine.
void requireOnce(const openvdb::GridCPtrVec& grids) {
    std::vector<std::string> names;
    names.reserve(grids.size());
    for (const auto& grid : grids) names.push_back(grid->getName());
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice == names.end()) return;
    throw Error(ErrorKind::Input,
                "the grid '" + *twice +
                    "' is no part of a larger one, and more than one of the files "
                    "has it");
}

}  // namespace

bool holdsShard(const openvdb::GridPtrVec& grids) {
    return std::any_of(grids.begin(), grids.end(), [](const openvdb::GridBase::Ptr& grid) {
        return shardMetadata(*grid).has_value();
    });
}

openvdb::GridCPtrVec joinShardFiles(CommandRun& run, const std::vector<std::string>& inputs,
                                    const openvdb::GridPtrVec& first) {
    Gathered gathered;
    gather(first, inputs[0], gathered);
    {
        const ProgressStage stage(run.progress(), "read", 0);
        for (std::size_t i = 1; i < inputs.size(); ++i) {
            run.progress().throwIfInterrupted();
            const openvdb::GridPtrVec grids = readGrids(inputs[i]);
            if (!holdsShard(grids)) {
                throw Error(ErrorKind::Input, "'" + inputs[i] +
                                                  "' holds no part of a larger grid, and '" +
                                                  inputs[0] + "' does");
            }
            gather(grids, inputs[i], gathered);
        }
    }
    requireOnce(gathered.whole);

    openvdb::GridCPtrVec written;
    const ProgressStage stage(run.progress(), "join", 0);
    for (Parts& parts : gathered.parts) {
        const JoinedGrid joined = joinShards(parts.parts, parts.files);
        run.progress().throwIfInterrupted();
        run.warn(joined.warnings, ErrorKind::Result);
        const auto voxels = static_cast<std::int64_t>(joined.grid->activeVoxelCount());
        run.say("joined   grid '" + parts.grid + "' of " +
                formatCount(static_cast<std::int64_t>(parts.parts.size()), "part", "parts") + ": " +
                formatCount(voxels, "active voxel", "active voxels"));
        if (voxels == 0) {
            throw Error(ErrorKind::Result,
                        "the grid '" + parts.grid + "' is empty, whatever part is looked at");
        }
        written.push_back(joined.grid);
    }
    for (const auto& grid : gathered.whole) {
        const auto whole = openvdb::ConstPtrCast<openvdb::GridBase>(grid->copyGrid());
        forgetPart(*whole);
        written.push_back(whole);
    }
    run.count("grids", written.size());
    return written;
}

}  // namespace bandvox::app
