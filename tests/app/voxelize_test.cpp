// What the voxelize command writes and reports.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class Voxelize : public testing::Test {
  protected:
    RunResult voxelize(Names arguments) {
        arguments.insert(arguments.begin(), "voxelize");
        return runBandvox(arguments, {.folder = mFolder.path()});
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
    expectFailure({"cube.obj", "-o", "v.vdb", "--voxel-size", "1e-300"}, 2, "voxel");
    expectFailure({"cube.obj", "-o", "v.vdb", "--voxel-size", "1e-5"}, 5, "memory");
    expectFailure({"shape:sphere", "-o", "v.vdb", "-r", "1000000"}, 5, "memory");
}

}  // namespace
}  // namespace bandvox::app_test
