// What the voxelize command writes and reports.

#include "build_places.h"
#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <cmath>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class Voxelize : public testing::Test {
  protected:
    RunResult voxelize(Names arguments) {
        arguments.insert(arguments.begin(), "voxelize");
        return runBandvox(arguments, {.folder = mFolder.path()});
    }

    /// With no driver for EGL.
    RunResult voxelizeWithoutDriver(Names arguments) {
        const Names start{"env", "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null",
                          build_places::command(), "voxelize"};
        arguments.insert(arguments.begin(), start.begin(), start.end());
        return runProgram(arguments, {.folder = mFolder.path()});
    }

    openvdb::FloatGrid::Ptr read(const std::string& name) {
        const openvdb::GridPtrVec grids = readVdb(mFolder / name);
        EXPECT_EQ(grids.size(), 1u);
        return openvdb::gridPtrCast<openvdb::FloatGrid>(grids.at(0));
    }

    TemporaryFolder mFolder;
};

TEST_F(Voxelize, TurnsAMeshIntoVoxels) {
    writeText(mFolder / "cube.obj", cubeObj());
    const RunResult result =
        voxelize({"cube.obj", "-o", "cube.vdb", "-r", "32", "--stats", "s.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(mFolder.contents(), (Names{"cube.obj", "cube.vdb", "s.json"}));
    for (const char* word : {"cube.obj", "12 triangles", "32 x 32 x 32 voxels", "volume"}) {
        EXPECT_NE(result.err.find(word), std::string::npos) << word << " in " << result.err;
    }
    const auto grid = read("cube.vdb");
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getName(), "density");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_DOUBLE_EQ(grid->voxelSize().x(), 2.0 / 32);
    EXPECT_NEAR(densityIntegral(*grid), 8, 1e-9);
    EXPECT_EQ(grid->metaValue<std::string>("bandvox_source"), "cube.obj");
    const auto counts = nlohmann::json::parse(readText(mFolder / "s.json")).at("counts");
    EXPECT_EQ(counts.at("voxels_inside"), 32 * 32 * 32);
    EXPECT_NEAR(counts.at("source_volume").get<double>(), 8, 1e-9);
}

TEST_F(Voxelize, CapsHolesAndSaysSo) {
    writeText(mFolder / "open.obj", openCubeObj());
    const RunResult result =
        voxelize({"open.obj", "-o", "v.vdb", "--voxel-size", "0.125", "--compression", "zip"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("1 hole"), std::string::npos) << result.err;
    EXPECT_EQ(read("v.vdb")->activeVoxelCount(), 16u * 16 * 16);
    std::filesystem::remove(mFolder / "v.vdb");
    EXPECT_EQ(voxelize({"open.obj", "-o", "v.vdb", "--strict"}).status, 3);
    EXPECT_EQ(mFolder.contents(), Names{"open.obj"});
}

TEST_F(Voxelize, TakesShapesByTheirFormula) {
    ASSERT_EQ(voxelize({"shape:sphere", "-o", "s.vdb", "-r", "20"}).status, 0);
    const auto grid = read("s.vdb");
    // The formula counts its surface in.
    EXPECT_EQ(grid->evalActiveVoxelBoundingBox(),
              openvdb::CoordBBox(openvdb::Coord(-10), openvdb::Coord(10)));
    EXPECT_NEAR(densityIntegral(*grid), 4.18879, 0.05);
}

TEST_F(Voxelize, TooFewVoxelsAreWorthAWarning) {
    const RunResult few = voxelize({"shape:sphere", "-o", "s.vdb", "-r", "1"});
    EXPECT_EQ(few.status, 0);
    EXPECT_NE(few.err.find("warning: the voxels hold 91 % more than the solid"), std::string::npos)
        << few.err;
    EXPECT_EQ(voxelize({"shape:sphere", "-o", "t.vdb", "-r", "1", "--strict"}).status, 4);
    EXPECT_EQ(mFolder.contents(), Names{"s.vdb"});
}

TEST_F(Voxelize, EveryBackendAndAxisGivesTheSame) {
    writeText(mFolder / "cube.obj", cubeObj());
    const Names common{"cube.obj", "-r", "21", "--stats", "s.json", "-o"};
    const auto run = [&](const std::string& output, const Names& more) {
        Names arguments = common;
        arguments.push_back(output);
        arguments.insert(arguments.end(), more.begin(), more.end());
        return voxelize(arguments);
    };
    const RunResult automatic = run("auto.vdb", {});
    ASSERT_EQ(automatic.status, 0) << automatic.err;
    EXPECT_EQ(countLines(automatic.err, "backend  "), 1) << automatic.err;
    const RunResult cpu = run("cpu.vdb", {"--backend", "cpu", "--axis", "y"});
    ASSERT_EQ(cpu.status, 0) << cpu.err;
    EXPECT_EQ(countLines(cpu.err, "backend  "), 0) << cpu.err;
    EXPECT_EQ(nlohmann::json::parse(readText(mFolder / "s.json")).at("counts").at("backend"),
              "cpu");
    const auto expected = read("cpu.vdb");
    EXPECT_TRUE(read("auto.vdb")->tree().hasSameTopology(expected->tree()));
    for (const Names& more : {Names{"--backend", "gpu"},
                              {"--backend", "gpu", "--gpu-method", "slices", "--axis", "z"}}) {
        const RunResult gpu = run("gpu.vdb", more);
        if (gpu.status == 1) GTEST_SKIP() << gpu.err;
        ASSERT_EQ(gpu.status, 0) << gpu.err;
        EXPECT_EQ(countLines(gpu.err, "backend  gpu: "), 1) << gpu.err;
        EXPECT_TRUE(read("gpu.vdb")->tree().hasSameTopology(expected->tree()));
        const auto counts = nlohmann::json::parse(readText(mFolder / "s.json")).at("counts");
        EXPECT_EQ(counts.at("backend"), "gpu");
        EXPECT_NE(gpu.err.find(counts.at("device").get<std::string>()), std::string::npos);
    }
}

TEST_F(Voxelize, DoesWithoutEglAndSaysSo) {
    writeText(mFolder / "cube.obj", cubeObj());
    const RunResult automatic = voxelizeWithoutDriver({"cube.obj", "-o", "v.vdb", "-r", "8"});
    EXPECT_EQ(automatic.status, 0) << automatic.err;
    EXPECT_EQ(countLines(automatic.err, "backend  cpu: "), 1) << automatic.err;
    std::filesystem::remove(mFolder / "v.vdb");
    const RunResult gpu =
        voxelizeWithoutDriver({"cube.obj", "-o", "v.vdb", "-r", "8", "--backend", "gpu"});
    EXPECT_EQ(gpu.status, 1) << gpu.err;
    EXPECT_EQ(countLines(gpu.err, "bandvox: error: "), 1) << gpu.err;
    EXPECT_NE(gpu.err.find("EGL"), std::string::npos) << gpu.err;
    EXPECT_EQ(mFolder.contents(), Names{"cube.obj"});
}

TEST_F(Voxelize, TakesSubSamples) {
    // With faces at ±2.85 voxels, the nearer ones of the sub-samples of voxel 3, at 2.75, are
    // inside.
    writeText(mFolder / "cube.obj", cubeObj());
    const auto sumOf = [&](double half, const Names& more) {
        const std::string voxelSize = std::to_string(1 / half);
        Names arguments{"cube.obj", "-o", "v.vdb", "--voxel-size", voxelSize, "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = voxelize(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return densityIntegral(*read("v.vdb")) * std::pow(1 / std::stod(voxelSize), 3);
    };
    for (const double half : {2.3, 2.6, 2.85}) EXPECT_NEAR(sumOf(half, {}), 125, 1e-6);
    EXPECT_NEAR(sumOf(2.6, {"--fraction"}), 125, 1e-6);
    EXPECT_NEAR(sumOf(2.85, {"--fraction"}), 6 * 6 * 6, 1e-6);
    EXPECT_NEAR(sumOf(2.85, {"--threshold", "8"}), 125, 1e-6);
    EXPECT_NEAR(sumOf(2.85, {"--threshold", "4"}), 125 + 6 * 25, 1e-6);
    EXPECT_NEAR(sumOf(2.85, {"--threshold", "2"}), 125 + 6 * 25 + 12 * 5, 1e-6);
    EXPECT_NEAR(sumOf(2.85, {"--threshold", "1", "--axis", "z"}), 7 * 7 * 7, 1e-6);
}

TEST_F(Voxelize, MakesAMask) {
    writeText(mFolder / "cube.obj", cubeObj());
    ASSERT_EQ(voxelize({"cube.obj", "-o", "m.vdb", "-r", "16", "--as", "mask"}).status, 0);
    const openvdb::GridPtrVec grids = readVdb(mFolder / "m.vdb");
    ASSERT_EQ(grids.size(), 1u);
    const auto mask = openvdb::gridPtrCast<openvdb::BoolGrid>(grids[0]);
    ASSERT_TRUE(mask);
    EXPECT_EQ(mask->getName(), "mask");
    EXPECT_EQ(mask->activeVoxelCount(), 16u * 16 * 16);
    EXPECT_EQ(mask->metaValue<std::string>("bandvox_source"), "cube.obj");
}

TEST_F(Voxelize, VoxelsCanBeDrawnByEveryShading) {
    ASSERT_EQ(voxelize({"shape:torus", "-o", "t.vdb", "-r", "32"}).status, 0);
    std::vector<std::string> pictures;
    for (const char* shading : {"spectral", "depth", "phong", "cross", "sobel2d", "sobel3d"}) {
        const RunResult result =
            runBandvox({"render", "t.vdb", "-o", "t.png", "--res", "24x24", "--shading", shading},
                       {.folder = mFolder.path()});
        ASSERT_EQ(result.status, 0) << shading << result.err;
        pictures.push_back(readText(mFolder / "t.png"));
        for (std::size_t i = 0; i + 1 < pictures.size(); ++i) {
            EXPECT_NE(pictures[i], pictures.back()) << shading;
        }
    }
}

TEST_F(Voxelize, SaysWhatCannotBe) {
    writeText(mFolder / "cube.obj", cubeObj());
    const auto expectFailure = [&](const Names& arguments, int status, const std::string& word) {
        const RunResult result = voxelize(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_EQ(mFolder.contents(), Names{"cube.obj"});
    };
    expectFailure({"none.obj", "-o", "v.vdb"}, 3, "none.obj");
    expectFailure({"cube.txt", "-o", "v.vdb"}, 3, "cannot voxelize 'cube.txt'");
    expectFailure({"shape:blob", "-o", "v.vdb"}, 3, "blob");
    expectFailure({"cube.obj", "-o", "v.png"}, 2, ".vdb");
    expectFailure({"cube.obj", "-o", "v.vdb", "-r", "8", "--voxel-size", "1"}, 2, "--voxel-size");
    expectFailure({"cube.obj", "-o", "v.vdb", "--threshold", "9"}, 2, "--threshold");
    expectFailure({"cube.obj", "-o", "v.vdb", "--threshold", "1", "--fraction"}, 2, "--fraction");
    expectFailure({"cube.obj", "-o", "v.vdb", "--as", "mask", "--fraction"}, 2, "mask");
    expectFailure({"cube.obj", "-o", "v.vdb", "--as", "fog"}, 2, "--as");
    expectFailure({"cube.obj", "-o", "v.vdb", "--axis", "w"}, 2, "--axis");
    expectFailure({"cube.obj", "-o", "v.vdb", "--backend", "tpu"}, 2, "--backend");
    expectFailure({"cube.obj", "-o", "v.vdb", "--backend", "cpu", "--gpu-method", "bits"}, 2,
                  "--gpu-method");
    expectFailure({"cube.obj", "-o", "v.vdb", "--backend", "gpu", "-r", "17000"}, 2, "16368");
    expectFailure({"shape:cube", "-o", "v.vdb", "--backend", "gpu"}, 2, "formula");
    expectFailure({"cube.obj", "-o", "v.vdb", "--voxel-size", "1e-300"}, 2, "voxel");
    expectFailure({"cube.obj", "-o", "v.vdb", "--voxel-size", "2e-5"}, 5, "memory");
    expectFailure({"shape:sphere", "-o", "v.vdb", "-r", "100000"}, 5, "memory");
}

}  // namespace
}  // namespace bandvox::app_test
