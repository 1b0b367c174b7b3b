// What the merge command makes of .vdb files.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::app_test {
namespace {

using Words = std::vector<std::string>;

class Merge : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        writeText(*sFolder / "cube.obj", coloredCubeObj());
        for (const Words& made :
             {Words{"shape:cube", "-o", "cube.vdb", "--voxel-size", "0.1"},
              Words{"shape:sphere", "-o", "ball.vdb", "--voxel-size", "0.1"},
              Words{"shape:sphere", "-o", "fine.vdb", "--voxel-size", "0.08"},
              Words{"shape:sphere", "-o", "sharp.vdb", "--voxel-size", "0.1", "--order", "4",
                    "--cutoff", "0.25"},
              Words{"cube.obj", "-o", "colored.vdb", "--voxel-size", "0.1", "--color"}}) {
            Words arguments{"convert"};
            arguments.insert(arguments.end(), made.begin(), made.end());
            const RunResult result = runBandvox(arguments, {.folder = sFolder->path()});
            ASSERT_EQ(result.status, 0) << result.err;
        }
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult merge(Words arguments, RunOptions options = {}) {
        arguments.insert(arguments.begin(), "merge");
        options.folder = sFolder->path();
        return runBandvox(arguments, options);
    }

    static openvdb::FloatGrid::Ptr only(const std::string& name) {
        const auto grids = readVdb(*sFolder / name);
        EXPECT_EQ(grids.size(), 1U);
        return openvdb::gridPtrCast<openvdb::FloatGrid>(grids.at(0));
    }

    // Expects a status, one line of error with these words, and no output.
    static void expectError(const Words& arguments, int status, const Words& words) {
        const RunResult result = merge(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
        for (const std::string& word : words) {
            EXPECT_NE(result.err.find(word), std::string::npos) << word << ": " << result.err;
        }
        EXPECT_FALSE(std::filesystem::exists(*sFolder / "none.vdb"));
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> Merge::sFolder;

TEST_F(Merge, OperationsHaveTheIntegralsThatTheyMust) {
    // The ball is inside the cube, and touches it at six places, where products are off.
    const double cube = densityIntegral(*only("cube.vdb"));
    const double ball = densityIntegral(*only("ball.vdb"));
    ASSERT_EQ(
        merge({"cube.vdb", "ball.vdb", "-o", "both.vdb", "--operation", "intersection"}).status, 0);
    const double both = densityIntegral(*only("both.vdb"));
    EXPECT_LT(both, ball);
    EXPECT_GT(both, 0.9 * ball);
    const std::vector<std::pair<std::string, double>> expected{{"union", cube + ball - both},
                                                               {"sum", cube + ball},
                                                               {"blend", (cube + ball) / 2},
                                                               {"difference", cube - both},
                                                               {"intersection", both}};
    for (const auto& [operation, integral] : expected) {
        const RunResult result = merge({"cube.vdb", "ball.vdb", "-o", "out.vdb", "--operation",
                                        operation, "--stats", "stats.json"});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out, "");
        const auto found = only("out.vdb");
        const auto metadata = densityMetadata(*found);
        ASSERT_TRUE(metadata);
        EXPECT_EQ(metadata->source, operation + " of shape:cube and shape:sphere");
        // What is next to nothing is left away.
        EXPECT_NEAR(metadata->gridVolume, integral, 2e-3) << operation;
        if (operation == "sum" || operation == "blend") {
            EXPECT_NEAR(metadata->gridVolume, integral, 1e-5) << operation;
        }
        const auto stats = nlohmann::json::parse(readText(*sFolder / "stats.json"));
        EXPECT_EQ(stats["counts"]["grids"], 2);
        EXPECT_EQ(stats["counts"]["active_voxels"], found->activeVoxelCount());
    }
}

TEST_F(Merge, TheLargerOfTwoIsNoLessThanEither) {
    ASSERT_EQ(merge({"cube.vdb", "ball.vdb", "-o", "max.vdb", "--operation", "max"}).status, 0);
    const auto found = only("max.vdb"), cube = only("cube.vdb"), ball = only("ball.vdb");
    for (auto value = found->cbeginValueOn(); value; ++value) {
        const openvdb::Coord at = value.getCoord();
        ASSERT_EQ(*value, std::max(cube->tree().getValue(at), ball->tree().getValue(at))) << at;
    }
    EXPECT_GE(densityIntegral(*found), densityIntegral(*cube));
}

TEST_F(Merge, TakesMoreThanTwoAndWeights) {
    const double ball = densityIntegral(*only("ball.vdb"));
    ASSERT_EQ(merge({"ball.vdb", "ball.vdb", "ball.vdb", "-o", "three.vdb", "--operation", "sum",
                     "--weights", "2,-0.5,0.25"})
                  .status,
              0);
    EXPECT_NEAR(densityIntegral(*only("three.vdb")), 1.75 * ball, 1e-5);
    EXPECT_NEAR(densityMetadata(*only("three.vdb"))->sourceVolume,
                1.75 * densityMetadata(*only("ball.vdb"))->sourceVolume, 1e-9);
    ASSERT_EQ(
        merge({"ball.vdb", "ball.vdb", "-o", "sum.vdb", "--operation", "sum", "--clamp", "--half"})
            .status,
        0);
    const auto sum = only("sum.vdb");
    EXPECT_EQ(sum->tree().getValue(openvdb::Coord(0)), 1);
    EXPECT_TRUE(densityMetadata(*sum)->clamped);
    EXPECT_GT(densityMetadata(*sum)->storageError, 0);
}

TEST_F(Merge, ReadsAndWritesTheStandardStreams) {
    writeText(*sFolder / "streamed.vdb", "");
    const RunResult result =
        merge({"stdin.vdb", "cube.vdb", "-o", "stdout.vdb", "--operation", "intersection"},
              {.standardInput = (*sFolder / "ball.vdb").string(),
               .standardOutput = (*sFolder / "streamed.vdb").string()});
    ASSERT_EQ(result.status, 0) << result.err;
    ASSERT_EQ(
        merge({"ball.vdb", "cube.vdb", "-o", "plain.vdb", "--operation", "intersection"}).status,
        0);
    EXPECT_EQ(densityIntegral(*only("streamed.vdb")), densityIntegral(*only("plain.vdb")));
}

TEST_F(Merge, BringsOtherLatticesToTheFirst) {
    expectError({"cube.vdb", "fine.vdb", "-o", "none.vdb"}, 3,
                {"'fine.vdb'", "(0.08, 0.08, 0.08)", "--resample", "--onto cube.vdb"});
    ASSERT_EQ(merge({"cube.vdb", "fine.vdb", "-o", "resampled.vdb", "--resample", "--operation",
                     "difference"})
                  .status,
              0);
    ASSERT_EQ(merge({"cube.vdb", "ball.vdb", "-o", "same.vdb", "--operation", "difference"}).status,
              0);
    const auto found = only("resampled.vdb"), expected = only("same.vdb");
    EXPECT_EQ(found->transform(), expected->transform());
    double largest = 0;
    for (auto value = expected->cbeginValueOn(); value; ++value) {
        largest =
            std::max<double>(largest, std::abs(*value - found->tree().getValue(value.getCoord())));
    }
    EXPECT_LT(largest, 4e-4);
}

TEST_F(Merge, SaysWhatItLeavesAway) {
    const RunResult result = merge({"colored.vdb", "ball.vdb", "-o", "left.vdb"});
    ASSERT_EQ(result.status, 0);
    EXPECT_EQ(countLines(result.err, "bandvox: warning: "), 1) << result.err;
    EXPECT_NE(result.err.find("'Cd'"), std::string::npos) << result.err;
    EXPECT_EQ(only("left.vdb")->getName(), "density");
    EXPECT_EQ(merge({"colored.vdb", "ball.vdb", "-o", "none.vdb", "--strict"}).status, 4);

    const RunResult filters = merge({"sharp.vdb", "ball.vdb", "-o", "filters.vdb"});
    ASSERT_EQ(filters.status, 0);
    EXPECT_NE(filters.err.find("different filters"), std::string::npos) << filters.err;
    EXPECT_FALSE(densityMetadata(*only("filters.vdb")));
}

TEST_F(Merge, RefusesLevelSetsAndSaysWhatToDo) {
    ASSERT_EQ(runBandvox({"convert", "ball.vdb", "-o", "distances.vdb", "--as", "level-set"},
                         {.folder = sFolder->path()})
                  .status,
              0);
    expectError({"cube.vdb", "distances.vdb", "-o", "none.vdb", "--grid", "surface"}, 3,
                {"'surface'"});
    expectError({"distances.vdb", "cube.vdb", "-o", "none.vdb"}, 3, {"level set", "--as density"});
}

TEST_F(Merge, RefusesWrongUsage) {
    expectError({"cube.vdb", "-o", "none.vdb"}, 2, {"B.vdb"});
    expectError({"cube.vdb", "ball.vdb"}, 2, {"-o"});
    expectError({"cube.vdb", "ball.vdb", "-o", "none.ply"}, 2, {".vdb"});
    expectError({"cube.vdb", "ball.vdb", "-o", "cube.vdb"}, 2, {"the same file"});
    expectError({"cube.vdb", "ball.vdb", "-o", "none.vdb", "--operation", "xor"}, 2,
                {"'xor'", "union"});
    expectError({"cube.vdb", "ball.vdb", "-o", "none.vdb", "--weights", "1,2"}, 2, {"union"});
    expectError({"cube.vdb", "ball.vdb", "-o", "none.vdb", "--operation", "sum", "--weights", "1"},
                2, {"--weights", "2 numbers"});
    expectError(
        {"cube.vdb", "ball.vdb", "-o", "none.vdb", "--operation", "sum", "--weights", "1,x"}, 2,
        {"--weights", "'1,x'"});
    expectError({"stdin.vdb", "stdin.vdb", "-o", "none.vdb"}, 2, {"stdin.vdb"});
    expectError({"cube.obj", "ball.vdb", "-o", "none.vdb"}, 3, {"bandvox convert cube.obj"});
    expectError({"cube.vdb", "missing.vdb", "-o", "none.vdb"}, 3, {"missing.vdb"});
    expectError({"cube.vdb", "ball.vdb", "-o", "none.vdb", "--grid", "heat"}, 3, {"'heat'"});
}

}  // namespace
}  // namespace bandvox::app_test
