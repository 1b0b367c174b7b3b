// bandvox info: what is in a .vdb file, in words or as JSON.

#include "command_run.h"
#include "commands.h"
#include "grid_report.h"
#include "standard_streams.h"
#include "vdb_input.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace bandvox::app {

const CommandTable& infoTable() {
    static const CommandTable table{
        "info",
        "Tell what is in a .vdb file.",
        "Tells of each grid in a .vdb file, of any type: its size in the world and in memory, and "
        "its metadata. For a density made by bandvox that includes how it was filtered and the "
        "error that was measured.",
        {{"INPUT", "A .vdb file; stdin.vdb is the standard input."}},
        {{"json", 0, "", "", "Print JSON instead of words.", "Output"}},
        {
            {"bandvox info bunny.vdb", "In words."},
            {"bandvox info bunny.vdb --json", "As JSON, for another program."},
        }};
    return table;
}

void runInfo(const CommandLine& line) {
    const std::string& input = line.positional(0);
    requireVdb("tell about", input);
    CommandRun run(line);

    openvdb::GridPtrVec grids;
    {
        const ProgressStage stage(run.progress(), "read", 0);
        grids = readGrids(input);
    }
    run.progress().throwIfInterrupted();

    nlohmann::ordered_json report;
    report["file"] = input;
    report["file_bytes"] = nullptr;
    if (!isStandardInput(input) && std::filesystem::is_regular_file(input)) {
        report["file_bytes"] = std::filesystem::file_size(input);
    }
    report["grids"] = nlohmann::ordered_json::array();
    for (const auto& grid : grids) report["grids"].push_back(gridReport(*grid));
    run.count("grids", grids.size());
    run.finish();
    writeResult(line.has("json")
                    ? report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
                    : reportInWords(report));
}

}  // namespace bandvox::app
