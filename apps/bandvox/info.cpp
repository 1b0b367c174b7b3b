// bandvox info: what is in a .vdb file, a mesh or free-form surfaces, in words or as JSON.

#include "command_run.h"
#include "commands.h"
#include "file_endings.h"
#include "grid_report.h"
#include "mesh_report.h"
#include "patch_report.h"
#include "solid_input.h"
#include "standard_streams.h"
#include "vdb_input.h"

#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::app {
namespace {

std::vector<std::string> infoEndings() {
    std::vector<std::string> endings = vdbAndMeshEndings();
    endings.emplace_back(".bpt");
    endings.insert(endings.end(), cadExtensions().begin(), cadExtensions().end());
    return endings;
}

}  // namespace

const CommandTable& infoTable() {
    static const CommandTable table{
        "info",
        "Tell what is in a .vdb file, or what is wrong with a mesh or free-form surfaces.",
        "Tells of each grid in a .vdb file, of any type: its size in the world and in memory, and "
        "its metadata. For a density made by bandvox that includes how it was filtered and the "
        "error that was measured. Of a mesh it tells its holes and whatever else keeps it from "
        "being the boundary of a solid, and the volume of the solid that is made of it; of "
        "free-form surfaces (.bpt, .obj, parts of CAD programs) the same.",
        {{"INPUT",
          "A .vdb file, a mesh, or free-form surfaces; stdin.vdb is the standard input.",
          false,
          {.endings = infoEndings()}}},
        {{"json", 0, "", "", "Print JSON instead of words.", "Output"}},
        {
            {"bandvox info bunny.vdb", "In words."},
            {"bandvox info bunny.vdb --json", "As JSON, for another program."},
            {"bandvox info bunny.obj", "The health of a mesh."},
            {"bandvox info teapot.bpt", "That of patches."},
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

void runPatchInfo(CommandRun& run, const CommandLine& line, const std::string& input) {
    const nlohmann::ordered_json report = patchReport(input, run.progress());
    run.count("patches", report["patches"]);
    run.finish();
    writeReport(line, report, patchReportInWords(report));
}

}  // namespace

void runInfo(const CommandLine& line) {
    const std::string& input = line.positional(0);
    const bool isPatches = isPatchFile(input);
    if (!isPatches && !isMeshFile(input)) requireVdb("tell about", input);
    CommandRun run(line);
    if (isPatches) return runPatchInfo(run, line, input);
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
