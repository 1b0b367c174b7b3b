#include "vdb_input.h"

#include "command_run.h"
#include "solid_input.h"
#include "words.h"

#include <bandvox/grid/join_shards.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>

#include <filesystem>

namespace bandvox::app {

void requireVdb(const std::string& verb, const std::string& input) {
    if (!isShape(input) && extensionOf(input) == ".vdb") return;
    std::string message = "cannot ";
    message += verb + " '" + input + "': expected a .vdb file";
    if (isShape(input) || isMeshFile(input) || isPatchFile(input)) {
        message += "; convert it first: bandvox convert " + shellWord(input) + " -o " +
                   shellWord((isShape(input) ? input.substr(input.find(':') + 1)
                                             : std::filesystem::path(input).stem().string()) +
                             ".vdb");
    }
    throw Error(ErrorKind::Input, message);
}

void warnOfPart(CommandRun& run, const openvdb::GridBase& grid, const std::string& file) {
    const auto part = shardMetadata(grid);
    if (!part || part->shard.isWhole()) return;
    run.warn({"the grid '" + grid.getName() + "' of '" + file + "' is part " +
              std::to_string(part->shard.index) + " of " + std::to_string(part->shard.count) +
              " of a larger one, and ends where that was cut; join the parts by bandvox merge"},
             ErrorKind::Input);
}

}  // namespace bandvox::app
