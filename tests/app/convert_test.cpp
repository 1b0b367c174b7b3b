// What the convert command writes and reports.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

RunResult convertIn(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "convert");
    return runBandvox(arguments, {.folder = folder.path()});
}

openvdb::FloatGrid::Ptr readDensity(const std::filesystem::path& path) {
    const openvdb::GridPtrVec grids = readVdb(path);
    EXPECT_EQ(grids.size(), 1u);
    return openvdb::gridPtrCast<openvdb::FloatGrid>(grids.at(0));
}

TEST(Convert, TurnsAMeshIntoADensity) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", cubeObj());
    const RunResult result = convertIn(folder, {"cube.obj", "-o", "cube.vdb", "-r", "32"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(folder.contents(), (Names{"cube.obj", "cube.vdb"}));
    for (const char* word : {"cube.obj", "12 triangles", "active voxels", "closure", "volume"}) {
        EXPECT_NE(result.err.find(word), std::string::npos) << word << " in " << result.err;
    }
    EXPECT_EQ(result.err.find('\r'), std::string::npos) << "progress without a terminal";

    const auto grid = readDensity(folder / "cube.vdb");
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getName(), "density");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_DOUBLE_EQ(grid->voxelSize().x(), 2.0 / 32);
    EXPECT_NEAR(densityIntegral(*grid), 8, 8e-4);
    const auto metadata = densityMetadata(*grid);
    ASSERT_TRUE(metadata);
    EXPECT_EQ(metadata->source, "cube.obj");
    EXPECT_EQ(metadata->holesCapped, 0);
    EXPECT_NEAR(metadata->sourceVolume, 8, 1e-6);
    EXPECT_LE(metadata->closureError, metadata->tolerance);
}

TEST(Convert, ReadsEveryKindOfMeshAlike) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", cubeObj());
    writeText(folder / "cube.ply", cubePly());
    writeText(folder / "text.stl", cubeStlAscii());
    writeText(folder / "binary.STL", cubeStlBinary());
    writeText(folder / "cube.glb", cubeGlb());
    for (const char* name : {"cube.obj", "cube.ply", "text.stl", "binary.STL", "cube.glb"}) {
        const RunResult result = convertIn(folder, {name, "-o", "out.vdb", "-r", "16"});
        ASSERT_EQ(result.status, 0) << name << ": " << result.err;
        EXPECT_NEAR(densityIntegral(*readDensity(folder / "out.vdb")), 8, 8e-4) << name;
    }
}

TEST(Convert, CapsHolesAndSaysSo) {
    const TemporaryFolder folder;
    writeText(folder / "open.obj", openCubeObj());
    const RunResult result = convertIn(folder, {"open.obj", "-o", "open.vdb", "-r", "16"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("1 hole"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("4 edges, perimeter 8"), std::string::npos) << result.err;
    const auto metadata = densityMetadata(*readDensity(folder / "open.vdb"));
    ASSERT_TRUE(metadata);
    EXPECT_EQ(metadata->holesCapped, 1);
    EXPECT_NEAR(metadata->gridVolume, 8, 8e-4);
}

TEST(Convert, TakesVoxelSizeFilterAndStorageOptions) {
    const TemporaryFolder folder;
    const RunResult result = convertIn(
        folder, {"shape:sphere", "-o", "s.vdb", "--voxel-size", "0.1", "--order", "4", "--cutoff",
                 "0.25", "--clamp", "--half", "--compression", "zip", "--iso", "0.4"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto grid = readDensity(folder / "s.vdb");
    ASSERT_TRUE(grid);
    EXPECT_DOUBLE_EQ(grid->voxelSize().x(), 0.1);
    EXPECT_TRUE(grid->saveFloatAsHalf());
    const auto metadata = densityMetadata(*grid);
    ASSERT_TRUE(metadata);
    EXPECT_EQ(metadata->source, "shape:sphere");
    EXPECT_EQ(metadata->order, 4);
    EXPECT_EQ(metadata->cutoff, 0.25);
    EXPECT_EQ(metadata->iso, 0.4);
    EXPECT_TRUE(metadata->clamped);
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        ASSERT_GE(*value, 0.0f);
        ASSERT_LE(*value, 1.0f);
    }
}

TEST(Convert, WritesTheSameGridForAnyNumberOfThreads) {
    const TemporaryFolder folder;
    std::vector<openvdb::FloatGrid::Ptr> grids;
    for (const char* threads : {"1", "2", "0"}) {
        const RunResult result =
            convertIn(folder, {"shape:torus", "-o", "t.vdb", "-r", "40", "--threads", threads});
        ASSERT_EQ(result.status, 0) << result.err;
        grids.push_back(readDensity(folder / "t.vdb"));
    }
    for (std::size_t i = 1; i < grids.size(); ++i) {
        ASSERT_TRUE(grids[i]->tree().hasSameTopology(grids[0]->tree()));
        const auto values = grids[0]->getConstAccessor();
        for (auto value = grids[i]->cbeginValueOn(); value; ++value) {
            ASSERT_EQ(*value, values.getValue(value.getCoord())) << value.getCoord();
        }
    }
}

// The error that is stated holds for what is in the file, not for what was before it.
TEST(Convert, StatesWhatSixteenBitsCost) {
    const TemporaryFolder folder;
    ASSERT_EQ(convertIn(folder, {"shape:sphere", "-o", "float.vdb", "-r", "40"}).status, 0);
    const RunResult result =
        convertIn(folder, {"shape:sphere", "-o", "half.vdb", "-r", "40", "--half"});
    ASSERT_EQ(result.status, 0);
    EXPECT_NE(result.err.find("16 bits change it by up to"), std::string::npos) << result.err;
    const auto exact = readDensity(folder / "float.vdb");
    const auto half = readDensity(folder / "half.vdb");
    double largest = 0;
    for (auto value = exact->cbeginValueOn(); value; ++value) {
        const double other = half->tree().getValue(value.getCoord());
        largest = std::max(largest, std::abs(*value - other));
    }
    EXPECT_GT(largest, 1e-4);
    EXPECT_DOUBLE_EQ(densityMetadata(*half)->storageError, largest);
    EXPECT_DOUBLE_EQ(densityMetadata(*half)->gridVolume, densityIntegral(*half));
    EXPECT_EQ(densityMetadata(*exact)->storageError, 0);
}

TEST(Convert, ReplacesAnOlderOutput) {
    const TemporaryFolder folder;
    writeText(folder / "cube.vdb", "something older");
    ASSERT_EQ(convertIn(folder, {"shape:cube", "-o", "cube.vdb", "-r", "16"}).status, 0);
    EXPECT_TRUE(readDensity(folder / "cube.vdb"));
    EXPECT_EQ(folder.contents(), Names{"cube.vdb"});
}

TEST(Convert, WritesToTheStandardOutput) {
    const TemporaryFolder folder;
    const RunResult result = convertIn(folder, {"shape:cube", "-o", "stdout.vdb", "-r", "16"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(folder.contents(), Names{});
    writeText(folder / "piped.vdb", result.out);
    EXPECT_NEAR(densityIntegral(*readDensity(folder / "piped.vdb")), 8, 8e-4);

    const RunResult full = runBandvox({"convert", "shape:cube", "-o", "stdout.vdb", "-r", "16"},
                                      {.folder = folder.path(), .standardOutput = "/dev/full"});
    EXPECT_EQ(full.status, 1) << full.err;
    const RunResult broken = runBandvox({"convert", "shape:torus", "-o", "stdout.vdb", "-r", "64"},
                                        {.folder = folder.path(), .standardOutputClosed = true});
    EXPECT_EQ(broken.status, 1) << broken.err;
}

TEST(Convert, WritesDevicesAndPipesInPlace) {
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/null", folder / "null");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = readText(folder / "pipe"); });
    const RunResult piped =
        convertIn(folder, {"shape:cube", "-o", "null", "-r", "16", "--stats", "pipe"});
    reader.join();
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(nlohmann::json::parse(received).at("command"), "convert");
    const RunResult printed =
        convertIn(folder, {"shape:cube", "-o", "/dev/null", "-r", "16", "--stats", "/dev/stdout"});
    EXPECT_EQ(printed.status, 0) << printed.err;
    EXPECT_EQ(nlohmann::json::parse(printed.out).at("command"), "convert");
    EXPECT_EQ(folder.contents(), (Names{"null", "pipe"}));
    EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
    EXPECT_TRUE(std::filesystem::is_character_file(folder / "null"));
}

TEST(Convert, FollowsLinksAndKeepsModes) {
    const TemporaryFolder folder;
    writeText(folder / "real.vdb", "older");
    std::filesystem::permissions(folder / "real.vdb", std::filesystem::perms(0600));
    std::filesystem::create_symlink("real.vdb", folder / "link.vdb");
    ASSERT_EQ(convertIn(folder, {"shape:cube", "-o", "link.vdb", "-r", "16"}).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.vdb"));
    EXPECT_TRUE(readDensity(folder / "real.vdb"));
    EXPECT_EQ(std::filesystem::status(folder / "real.vdb").permissions(),
              std::filesystem::perms(0600));
}

TEST(Convert, TakesTheLongestNames) {
    const TemporaryFolder folder;
    std::string name(251, 'n');
    name += ".vdb";
    const RunResult result = convertIn(folder, {"shape:cube", "-o", name, "-r", "16"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(folder.contents(), Names{name});
}

TEST(Convert, QuietSaysNothing) {
    const TemporaryFolder folder;
    const RunResult result =
        convertIn(folder, {"shape:cube", "-o", "cube.vdb", "-r", "16", "--quiet"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
}

TEST(Convert, VerboseSaysMore) {
    const TemporaryFolder folder;
    const Names arguments{"shape:cube", "-o", "cube.vdb", "-r", "16", "--progress", "never"};
    Names verbose = arguments;
    verbose.emplace_back("--verbose");
    const int plainLines = countLines(convertIn(folder, arguments).err, "");
    EXPECT_GT(countLines(convertIn(folder, verbose).err, ""), plainLines);
}

TEST(Convert, WritesStatistics) {
    const TemporaryFolder folder;
    writeText(folder / "open.obj", openCubeObj());
    const RunResult result = convertIn(
        folder, {"open.obj", "-o", "a.vdb", "-r", "16", "--stats", "s.json", "--threads", "1"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(folder.contents(), (Names{"a.vdb", "open.obj", "s.json"}));
    const auto statistics = nlohmann::json::parse(readText(folder / "s.json"));
    EXPECT_EQ(statistics.at("command"), "convert");
    EXPECT_EQ(statistics.at("threads"), 1);
    EXPECT_GT(statistics.at("seconds").get<double>(), 0);
    EXPECT_GT(statistics.at("peak_memory_bytes").get<double>(), 1e6);
    EXPECT_GE(statistics.at("stages").size(), 2u);
    double stages = 0;
    for (const auto& stage : statistics.at("stages")) {
        EXPECT_FALSE(stage.at("name").get<std::string>().empty());
        stages += stage.at("seconds").get<double>();
    }
    EXPECT_LE(stages, statistics.at("seconds").get<double>());
    const auto& counts = statistics.at("counts");
    EXPECT_EQ(counts.at("triangles"), 10);
    EXPECT_EQ(counts.at("holes_capped"), 1);
    EXPECT_GT(counts.at("active_voxels").get<int>(), 16 * 16 * 16);
    EXPECT_EQ(counts.at("output_bytes").get<std::size_t>(),
              std::filesystem::file_size(folder / "a.vdb"));
}

TEST(Convert, StrictTakesAWarningForAFailure) {
    const TemporaryFolder folder;
    // The filter lets through a little more than the tolerance at the lattice's highest frequency.
    const Names arguments{"shape:cube", "-o", "a.vdb", "-r", "16", "--cutoff", "0.17"};
    const RunResult plain = convertIn(folder, arguments);
    EXPECT_EQ(plain.status, 0) << plain.err;
    EXPECT_EQ(countLines(plain.err, "bandvox: warning: "), 1) << plain.err;
    EXPECT_EQ(folder.contents(), Names{"a.vdb"});
    std::filesystem::remove(folder / "a.vdb");

    Names strict = arguments;
    strict.insert(strict.end(), {"--strict", "--stats", "s.json"});
    const RunResult result = convertIn(folder, strict);
    EXPECT_EQ(result.status, 4) << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: warning: "), 1) << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
    EXPECT_EQ(folder.contents(), Names{});
}

TEST(Convert, SampledRouteStatesItsError) {
    const TemporaryFolder folder;
    const RunResult result = convertIn(folder, {"shape:sphere", "-o", "s.vdb", "-r", "20",
                                                "--route", "sampled", "--oversample", "4"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("measured by halving the samples"), std::string::npos) << result.err;
    const RunResult info = runBandvox({"info", "s.vdb", "--json"}, {.folder = folder.path()});
    const auto own = nlohmann::json::parse(info.out)["grids"][0]["bandvox"];
    EXPECT_EQ(own["route"], "sampled");
    EXPECT_EQ(own["oversampling"], 4);
    EXPECT_GT(own["sampling_error"], 0.001);
    EXPECT_LT(own["sampling_error"], 0.2);

    // What does not go together is wrong usage.
    writeText(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::vector<std::vector<std::string>> wrong = {
        {"a.obj", "-o", "a.vdb", "--route", "sampled"},
        {"shape:sphere", "-o", "a.vdb", "--oversample", "4"},
        {"shape:sphere", "-o", "a.vdb", "--route", "sampled", "--oversample", "65"},
        {"shape:sphere", "-o", "a.vdb", "--route", "round"}};
    for (const auto& arguments : wrong) {
        EXPECT_EQ(convertIn(folder, arguments).status, 2) << arguments.back();
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.vdb"));
}

TEST(Convert, OutputOpensInVdbPrint) {
    if (!hasProgram("vdb_print")) GTEST_SKIP() << "vdb_print is not installed";
    const TemporaryFolder folder;
    ASSERT_EQ(convertIn(folder, {"shape:cube", "-o", "cube.vdb", "-r", "16"}).status, 0);
    const RunResult result = runProgram({"vdb_print", "-l", "cube.vdb"}, {.folder = folder.path()});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("density"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("bandvox_cutoff"), std::string::npos) << result.out;
}

TEST(Convert, OutputOpensInPython) {
    const Names python{"/usr/bin/python3", "-c"};
    const auto runPython = [&](const std::string& code, const std::filesystem::path& folder) {
        return runProgram({python[0], python[1], code}, {.folder = folder});
    };
    if (runPython("import pyopenvdb", "/").status != 0) {
        GTEST_SKIP() << "Python's pyopenvdb is not installed";
    }
    const TemporaryFolder folder;
    ASSERT_EQ(convertIn(folder, {"shape:cube", "-o", "cube.vdb", "-r", "16"}).status, 0);
    const RunResult result = runPython(
        "import pyopenvdb as v\n"
        "g = v.read('cube.vdb', 'density')\n"
        "assert g.gridClass == 'fog volume', g.gridClass\n"
        "assert abs(g.getConstAccessor().getValue((0, 0, 0)) - 1) < 1e-3\n"
        "assert abs(g['bandvox_source_volume'] - 8) < 1e-6\n",
        folder.path());
    EXPECT_EQ(result.status, 0) << result.err;
}

// Blender does not only list the grid, it makes a surface of it where the density is one half.
TEST(Convert, OutputOpensInBlender) {
    if (!hasProgram("blender")) GTEST_SKIP() << "Blender is not installed";
    const TemporaryFolder folder;
    ASSERT_EQ(runBandvox({"convert", "shape:cube", "-o", "cube.vdb", "-r", "32"},
                         {.folder = folder.path()})
                  .status,
              0);
    writeText(folder / "open.py",
              "import bpy, sys\n"
              "bpy.ops.object.volume_import(filepath=sys.argv[-1])\n"
              "volume = bpy.context.object\n"
              "surface = bpy.data.objects.new('surface', bpy.data.meshes.new('surface'))\n"
              "bpy.context.scene.collection.objects.link(surface)\n"
              "change = surface.modifiers.new('surface', 'VOLUME_TO_MESH')\n"
              "change.object = volume\n"
              "change.grid_name = 'density'\n"
              "change.threshold = 0.5\n"
              "graph = bpy.context.evaluated_depsgraph_get()\n"
              "points = [v.co for v in surface.evaluated_get(graph).to_mesh().vertices]\n"
              "print('EXTENT', *(round(max(p[i] for p in points) - min(p[i] for p in points), 1)"
              " for i in range(3)))\n");
    const RunResult result =
        runProgram({"blender", "-b", "--factory-startup", "-P", (folder / "open.py").string(), "--",
                    (folder / "cube.vdb").string()},
                   {.folder = folder.path()});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("EXTENT 2.0 2.0 2.0"), std::string::npos) << result.out << result.err;
}

}  // namespace
}  // namespace bandvox::app_test
