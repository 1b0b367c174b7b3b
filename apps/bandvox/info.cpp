// bandvox info: what is in a .vdb file or a mesh, in words or as JSON.

#include "command_run.h"
#include "commands.h"
#include "file_endings.h"
#include "grid_report.h"
#include "mesh_report.h"
#include "standard_streams.h"
#include "vdb_input.h"

#include <bandvox/source/read_mesh.h>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace bandvox::app {

const CommandTable& infoTable() {
    static const CommandTable table{
        "info",
        "Tell what is in a .vdb file, or what is wrong with a mesh.",
        "Tells of each grid in a .vdb file, of any type: its size in the world and in memory, and "
        "its metadata. For a density made by bandvox that includes how it was filtered and the "
        "error that was measured. Of a mesh it tells its holes and whatever else keeps it from "
        "being the boundary of a solid, and the volume of the solid that is made of it.",
        {{"INPUT",
          "A .vdb file, or a mesh; stdin.vdb is the standard input.",
          false,
          {.endings = vdbAndMeshEndings()}}},
        {{"json", 0, "", "", "Print JSON instead of words.", "Output"}},
        {
            {"bandvox info bunny.vdb", "In words."},
            {"bandvox info bunny.vdb --json", "As JSON, for another program."},
            {"bandvox info bunny.obj", "The health of a mesh."},
        }};
    return table;
}

namespace {

void writeReport(const CommandLine& line, const nlohmann::ordered_json& report,
                 const std::string& inWords) {
    writeResult(line.has("json")
                    ? report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"
                    : inWords);
}

void runMeshInfo(CommandRun& run, const CommandLine& line, const std::string& input) {
    const nlohmann::ordered_json report = meshReport(input, run.progress());
    run.count("triangles", report["triangles"]);
    run.finish();
    writeReport(line, report, meshReportInWords(report));
}

}  // namespace

void runInfo(const CommandLine& line) {
    const std::string& input = line.positional(0);
    if (!isMeshFile(input)) requireVdb("tell about", input);
    CommandRun run(line);
    if (isMeshFile(input)) return runMeshInfo(run, line, input);

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
    writeReport(line, report, reportInWords(report));
}

}  // namespace bandvox::app
