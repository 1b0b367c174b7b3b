// What the info command tells of grids of any type.

#include "build_places.h"
#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;

TEST(Info, TellsOfADensityAsJson) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    ASSERT_EQ(runBandvox({"convert", "shape:cube", "-o", "cube.vdb", "-r", "20"}, here).status, 0);
    const RunResult result = runBandvox({"info", "cube.vdb", "--json"}, here);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Json report = Json::parse(result.out);
    EXPECT_EQ(report.at("file"), "cube.vdb");
    EXPECT_EQ(report.at("file_bytes"), std::filesystem::file_size(folder / "cube.vdb"));
    ASSERT_EQ(report.at("grids").size(), 1u);
    const Json& grid = report.at("grids").at(0);
    EXPECT_EQ(grid.at("name"), "density");
    EXPECT_EQ(grid.at("class"), "fog volume");
    EXPECT_EQ(grid.at("value_type"), "float");
    EXPECT_EQ(grid.at("voxel_size"), (Json{0.1, 0.1, 0.1}));
    EXPECT_GT(grid.at("active_voxels").get<int>(), 20 * 20 * 20);
    EXPECT_GT(grid.at("memory_bytes").get<int>(), 20 * 20 * 20);
    EXPECT_LE(grid.at("world_bounds").at("min").at(0).get<double>(), -1);
    EXPECT_GE(grid.at("world_bounds").at("max").at(2).get<double>(), 1);
    const Json& own = grid.at("bandvox");
    EXPECT_EQ(own.at("source"), "shape:cube");
    EXPECT_EQ(own.at("route"), "exact");
    EXPECT_NEAR(own.at("source_volume").get<double>(), 8, 1e-6);
    EXPECT_EQ(own.at("holes_capped"), 0);
}

TEST(Info, TellsOfADensityInWords) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    ASSERT_EQ(runBandvox({"convert", "shape:cube", "-o", "cube.vdb", "-r", "20"}, here).status, 0);
    const RunResult result = runBandvox({"info", "cube.vdb"}, here);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* words : {"1 grid", "grid 'density'", "fog volume", "(0.1, 0.1, 0.1)",
                              "source: shape:cube", "closure_error: "}) {
        EXPECT_NE(result.out.find(words), std::string::npos) << words << " in " << result.out;
    }
}

TEST(Info, TakesGridsOfAnyType) {
    const TemporaryFolder folder;
    writeSeveralGrids(folder / "several.vdb");
    const RunOptions here{.folder = folder.path()};
    const RunResult result = runBandvox({"info", "several.vdb", "--json"}, here);
    ASSERT_EQ(result.status, 0) << result.err;
    const Json grids = Json::parse(result.out).at("grids");
    ASSERT_EQ(grids.size(), 4u);
    const auto named = [&](const std::string& name) {
        for (const Json& grid : grids) {
            if (grid.at("name") == name) return grid;
        }
        return Json();
    };
    EXPECT_EQ(named("heat").at("index_bounds").at("min"), (Json{1, 2, 3}));
    // The voxel is a cube of side 0.5 around its centre.
    EXPECT_EQ(named("heat").at("world_bounds").at("min"), (Json{0.25, 0.75, 1.25}));
    EXPECT_EQ(named("heat").at("world_bounds").at("max"), (Json{0.75, 1.25, 1.75}));
    EXPECT_FALSE(named("heat").contains("bandvox"));
    EXPECT_EQ(named("vel").at("value_type"), "vec3s");
    // Bytes that are no UTF-8 cannot stand in JSON.
    EXPECT_EQ(named("vel").at("metadata").at("note"), "two\nlines, and a byte: \xEF\xBF\xBD");
    EXPECT_EQ(named("mask").at("active_voxels"), 0);
    EXPECT_TRUE(named("mask").at("index_bounds").is_null());

    const RunResult words = runBandvox({"info", "several.vdb"}, here);
    EXPECT_EQ(words.status, 0);
    EXPECT_EQ(countLines(words.out, "grid '"), 4);
    EXPECT_NE(words.out.find("empty"), std::string::npos);
}

TEST(Info, ReadsTheStandardInput) {
    const TemporaryFolder folder;
    writeSeveralGrids(folder / "several.vdb");
    const RunResult result =
        runProgram({"/bin/sh", "-c", "cat several.vdb | \"$0\" info stdin.vdb --json",
                    build_places::command()},
                   {.folder = folder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    const Json report = Json::parse(result.out);
    EXPECT_EQ(report.at("grids").size(), 4u);
    EXPECT_TRUE(report.at("file_bytes").is_null());
    const RunResult words =
        runBandvox({"info", "stdin.vdb"},
                   {.folder = folder.path(), .standardInput = (folder / "several.vdb").string()});
    EXPECT_EQ(words.status, 0) << words.err;
    EXPECT_EQ(countLines(words.out, "stdin.vdb: 4 grids"), 1) << words.out;
}

TEST(Info, WritesControlCharactersOut) {
    const TemporaryFolder folder;
    writeOddlyNamedGrid(folder / "odd.vdb");
    const RunOptions here{.folder = folder.path()};
    const std::string shown = "'two\\nlines\\x1b[31m'";
    const RunResult info = runBandvox({"info", "odd.vdb"}, here);
    EXPECT_NE(info.out.find(shown), std::string::npos) << info.out;
    const RunResult drawn = runBandvox(
        {"render", "odd.vdb", "-o", "odd.png", "--res", "8x8", "--progress", "never"}, here);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(countLines(drawn.err, ""), 3) << drawn.err;
    EXPECT_NE(drawn.err.find(shown), std::string::npos) << drawn.err;
    const RunResult failed =
        runBandvox({"render", "odd.vdb", "-o", "odd.png", "--grid", "none", "--quiet"}, here);
    EXPECT_EQ(countLines(failed.err, ""), 1) << failed.err;
    for (const RunResult& result : {info, drawn, failed}) {
        EXPECT_EQ((result.out + result.err).find('\x1b'), std::string::npos);
    }
}

TEST(Info, ReaderThatGoesAwayIsNoFailure) {
    const TemporaryFolder folder;
    writeSeveralGrids(folder / "several.vdb");
    const RunResult result = runBandvox({"info", "several.vdb"},
                                        {.folder = folder.path(), .standardOutputClosed = true});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err, "");
}

TEST(Info, FullStandardOutputIsAFailure) {
    const TemporaryFolder folder;
    writeSeveralGrids(folder / "several.vdb");
    const RunResult result = runBandvox({"info", "several.vdb"},
                                        {.folder = folder.path(), .standardOutput = "/dev/full"});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
    EXPECT_NE(result.err.find("standard output"), std::string::npos) << result.err;
}

TEST(Info, WritesStatistics) {
    const TemporaryFolder folder;
    writeSeveralGrids(folder / "several.vdb");
    const RunResult result =
        runBandvox({"info", "several.vdb", "--stats", "s.json"}, {.folder = folder.path()});
    EXPECT_EQ(result.status, 0) << result.err;
    const Json statistics = Json::parse(readText(folder / "s.json"));
    EXPECT_EQ(statistics.at("command"), "info");
    EXPECT_EQ(statistics.at("counts").at("grids"), 4);
}

// A flat patch, a side of a box from corner to corner.
std::string flatPatch(const std::array<std::array<double, 3>, 4>& corners) {
    std::ostringstream text;
    text << "1 1\n";
    for (const auto& p : corners) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    return text.str();
}

// Of a box of sides 2, 3, 4 with its top left out if it is open.
std::string boxOfPatches(bool isOpen) {
    std::string text = isOpen ? "5\n" : "6\n";
    text += flatPatch({{{0, 0, 0}, {0, 3, 0}, {2, 0, 0}, {2, 3, 0}}});
    text += flatPatch({{{0, 0, 0}, {0, 0, 4}, {0, 3, 0}, {0, 3, 4}}});
    text += flatPatch({{{2, 0, 0}, {2, 3, 0}, {2, 0, 4}, {2, 3, 4}}});
    text += flatPatch({{{0, 0, 0}, {2, 0, 0}, {0, 0, 4}, {2, 0, 4}}});
    text += flatPatch({{{0, 3, 0}, {0, 3, 4}, {2, 3, 0}, {2, 3, 4}}});
    if (!isOpen) text += flatPatch({{{0, 0, 4}, {2, 0, 4}, {0, 3, 4}, {2, 3, 4}}});
    return text;
}

TEST(Info, TellsOfPatchesWhatItTellsOfMeshes) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    writeText(folder.path() / "box.bpt", boxOfPatches(false));
    writeText(folder.path() / "open.bpt", boxOfPatches(true));
    const auto box = Json::parse(runBandvox({"info", "box.bpt", "--json"}, here).out);
    EXPECT_EQ(box.at("patches"), 6);
    EXPECT_EQ(box.at("closed"), true);
    EXPECT_NEAR(box.at("volume").get<double>(), 24, 1e-9);
    EXPECT_NEAR(box.at("area").get<double>(), 52, 1e-9);
    const std::vector<double> high = box.at("bounds").at("max");
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(high[c], 2.0 + static_cast<double>(c), 1e-9);
    EXPECT_TRUE(box.at("problem").is_null());
    const auto open = Json::parse(runBandvox({"info", "open.bpt", "--json"}, here).out);
    EXPECT_EQ(open.at("closed"), false);
    ASSERT_EQ(open.at("holes").size(), 1U);
    EXPECT_NEAR(open.at("holes")[0].at("perimeter").get<double>(), 10, 1e-9);
    EXPECT_NEAR(open.at("volume").get<double>(), 24, 1e-9);
    const RunResult words = runBandvox({"info", "box.bpt"}, here);
    EXPECT_EQ(words.status, 0);
    EXPECT_NE(words.out.find("free-form surfaces"), std::string::npos) << words.out;
    // One that encloses nothing has bounds nevertheless.
    writeText(folder.path() / "flat.bpt",
              "1\n" + flatPatch({{{0, 0, 0}, {0, 3, 0}, {2, 0, 0}, {2, 3, 0}}}));
    const auto flat = Json::parse(runBandvox({"info", "flat.bpt", "--json"}, here).out);
    EXPECT_TRUE(flat.at("volume").is_null());
    EXPECT_TRUE(flat.at("problem").is_string());
    EXPECT_EQ(flat.at("bounds").at("max")[1], 3);
    EXPECT_EQ(runBandvox({"info", "none.bpt"}, here).status, 3);
}

TEST(Info, NamesAFileWithoutPatchesAndReadsPipes) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    writeText(folder.path() / "none.bpt", "0\n");
    const RunResult none = runBandvox({"info", "none.bpt"}, here);
    EXPECT_NE(none.out.find("'none.bpt' has no patches"), std::string::npos) << none.out;
    writeText(folder.path() / "box.bpt", boxOfPatches(false));
    const RunResult pipe = runProgram(
        {"sh", "-c", "mkfifo pipe.bpt && { cat box.bpt > pipe.bpt 2>/dev/null & }"}, here);
    EXPECT_EQ(pipe.status, 0);
    const RunResult read = runBandvox({"info", "pipe.bpt"}, here);
    EXPECT_EQ(read.status, 0) << read.err;
    EXPECT_NE(read.out.find("pipe.bpt: free-form surfaces"), std::string::npos) << read.out;
}

TEST(Info, OfPatchesOtherCommandsQuoteNamesForShells) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    writeText(folder.path() / "it's a.bpt", boxOfPatches(false));
    const RunResult render = runBandvox({"render", "it's a.bpt", "-o", "a.png"}, here);
    EXPECT_NE(render.err.find("convert 'it'\\''s a.bpt' -o 'it'\\''s a.vdb'"), std::string::npos)
        << render.err;
    const RunResult voxelize = runBandvox({"voxelize", "it's a.bpt", "-o", "a.vdb"}, here);
    EXPECT_NE(voxelize.err.find("-o 'it'\\''s a-mesh.ply' --res"), std::string::npos)
        << voxelize.err;
}

TEST(Info, OfPatchesOtherCommandsSayWhatToDo) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    writeText(folder.path() / "box.bpt", boxOfPatches(false));
    writeText(folder.path() / "sheet.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ncstype bezier\ndeg 1 1\n"
              "surf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n");
    for (const std::string file : {"box.bpt", "sheet.obj"}) {
        const std::vector<Names> commands{{"compare", file, file},
                                          {"render", file, "-o", "a.png"},
                                          {"voxelize", file, "-o", "a.vdb"},
                                          {"merge", file, file, "-o", "a.vdb"}};
        for (const Names& command : commands) {
            const RunResult result = runBandvox(command, here);
            EXPECT_EQ(result.status, 3) << command[0] << file << result.err;
            EXPECT_NE(result.err.find("bandvox convert " + file), std::string::npos)
                << command[0] << result.err;
        }
    }
    // What voxelize says can be done.
    EXPECT_EQ(
        runBandvox({"convert", "box.bpt", "-o", "box-mesh.ply", "--resolution", "24"}, here).status,
        0);
    EXPECT_EQ(runBandvox({"voxelize", "box-mesh.ply", "-r", "16", "-o", "a.vdb"}, here).status, 0);
}

}  // namespace
}  // namespace bandvox::app_test
