// What the compare command tells of volumes and meshes.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Words = std::vector<std::string>;

class Compare : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        writeText(*sFolder / "cube.obj", cubeObj());
        writeText(*sFolder / "open.obj", openCubeObj());
        writeSeveralGrids(*sFolder / "several.vdb");
        openvdb::io::File(*sFolder / "empty.vdb").write(openvdb::GridPtrVec{[] {
            auto grid = openvdb::FloatGrid::create(0.0F);
            grid->setName("density");
            return grid;
        }()});
        for (const Words& made : {Words{"shape:cube", "-o", "cube.vdb", "--voxel-size", "0.1"},
                                  Words{"shape:sphere", "-o", "ball.vdb", "--voxel-size", "0.1"},
                                  Words{"shape:cube", "-o", "fine.vdb", "--voxel-size", "0.08"}}) {
            Words arguments{"convert"};
            arguments.insert(arguments.end(), made.begin(), made.end());
            const RunResult result = runBandvox(arguments, {.folder = sFolder->path()});
            ASSERT_EQ(result.status, 0) << result.err;
        }
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult compare(Words arguments, RunOptions options = {}) {
        arguments.insert(arguments.begin(), "compare");
        options.folder = sFolder->path();
        return runBandvox(arguments, options);
    }

    static nlohmann::json report(Words arguments) {
        arguments.emplace_back("--json");
        const RunResult result = compare(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return nlohmann::json::parse(result.out);
    }

    static void expectError(const Words& arguments, int status, const Words& words) {
        const RunResult result = compare(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
        for (const std::string& word : words) {
            EXPECT_NE(result.err.find(word), std::string::npos) << word << ": " << result.err;
        }
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> Compare::sFolder;

TEST_F(Compare, AFileIsLikeItself) {
    const auto found = report({"cube.vdb", "cube.vdb"});
    EXPECT_EQ(found["values"]["maximum"], 0);
    EXPECT_EQ(found["values"]["rms"], 0);
    EXPECT_EQ(found["values"]["lattices"], "same");
    EXPECT_LT(found["surfaces"]["hausdorff"].get<double>(), 1e-12);
    EXPECT_LT(found["surfaces"]["angle"]["maximum"].get<double>(), 1e-5);
    EXPECT_EQ(found["volume_difference"], 0);
    EXPECT_EQ(found["integral_difference"], 0);
    EXPECT_EQ(compare({"cube.vdb", "cube.vdb", "--fail-above", "0"}).status, 0);
}

TEST_F(Compare, ABallInACube) {
    const auto found = report({"cube.vdb", "ball.vdb"});
    EXPECT_NEAR(found["values"]["maximum"].get<double>(), 0.9, 0.05) << "near a corner";
    // From a corner of the cube to the ball. A Gaussian of deviation s takes the cube's corners
    // back to where the error function's cube is a half, and the ball's radius by s² / r.
    constexpr double kDeviation = 0.1 / (1.41421356 * 3.14159265 * 0.16);
    constexpr double kHalfOfCorner = 0.8193;  // Φ(it)³ = 0.5
    const double hausdorff = found["surfaces"]["hausdorff"];
    EXPECT_NEAR(hausdorff,
                std::sqrt(3.0) * (1 - kHalfOfCorner * kDeviation) - (1 - kDeviation * kDeviation),
                3e-3);
    EXPECT_EQ(found["surfaces"]["from_a"]["maximum"], hausdorff);
    EXPECT_NEAR(found["surfaces"]["from_b"]["maximum"].get<double>(), 1 - 1 / std::sqrt(3.0), 0.03);
    EXPECT_GE(found["surfaces"]["hausdorff_at_most"].get<double>(), hausdorff);
    EXPECT_NEAR(found["integral_difference"].get<double>(), 3.14159265 / 6 - 1, 1e-3);
    EXPECT_NEAR(found["voxel"].get<double>(), 0.1, 1e-9);
    EXPECT_EQ(found["a"]["iso"], 0.5);

    const auto back = report({"ball.vdb", "cube.vdb"});
    EXPECT_EQ(back["surfaces"]["hausdorff"], hausdorff);
    EXPECT_EQ(back["surfaces"]["angle"], found["surfaces"]["angle"]);
    EXPECT_EQ(back["values"]["maximum"], found["values"]["maximum"]);
    EXPECT_NEAR(back["values"]["mean"].get<double>(), -found["values"]["mean"].get<double>(),
                1e-12);
}

TEST_F(Compare, InWordsItTellsTheSame) {
    const RunResult result = compare({"cube.vdb", "fine.vdb"});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* words : {"cube.vdb", "fine.vdb", "Hausdorff", "voxels)", "normals", "volume",
                              "integral", "B read between its voxels", "rms"}) {
        EXPECT_NE(result.out.find(words), std::string::npos) << words << '\n' << result.out;
    }
}

TEST_F(Compare, AVolumeWithTheMeshThatItIsMadeOf) {
    for (const char* mesh : {"cube.obj", "open.obj"}) {
        const auto found = report({"cube.vdb", mesh});
        EXPECT_TRUE(found["values"].is_null());
        EXPECT_TRUE(found["b"]["grid"].is_null());
        EXPECT_NEAR(found["b"]["volume"].get<double>(), 8, 1e-9);
        // Faces are where they were; the filter takes the edges and corners away.
        EXPECT_LT(found["surfaces"]["mean_distance"].get<double>(), 0.05);
        EXPECT_GT(found["surfaces"]["from_b"]["maximum"].get<double>(), 0.05);
        EXPECT_LT(found["surfaces"]["from_b"]["maximum"].get<double>(), 0.3);
        const auto back = report({mesh, "cube.vdb"});
        EXPECT_EQ(back["surfaces"]["hausdorff"], found["surfaces"]["hausdorff"]);
    }
    const auto meshes = report({"cube.obj", "open.obj"});
    EXPECT_LT(meshes["surfaces"]["hausdorff"].get<double>(), 1e-12);
    EXPECT_TRUE(meshes["voxel"].is_null());
}

TEST_F(Compare, SurfacesMayBeThoseOfTheSourcesVolume) {
    const auto found = report({"ball.vdb", "cube.vdb", "--iso", "volume", "--only", "surfaces"});
    EXPECT_NEAR(found["a"]["volume"].get<double>(), 4 * 3.14159265 / 3, 1e-4);
    EXPECT_NEAR(found["b"]["volume"].get<double>(), 8, 1e-4);
    EXPECT_LT(found["a"]["iso"].get<double>(), 0.5);
}

TEST_F(Compare, FailsAboveWhatIsAllowed) {
    for (const char* metric :
         {"max", "rms", "hausdorff", "mean-distance", "volume", "integral", "angle"}) {
        const Words arguments{"cube.vdb", "ball.vdb", "--metric", metric, "--fail-above"};
        Words loose = arguments, strict = arguments;
        loose.emplace_back("180");
        strict.emplace_back("1e-3");
        EXPECT_EQ(compare(loose).status, 0) << metric;
        const RunResult result = compare(strict);
        EXPECT_EQ(result.status, 4) << metric;
        EXPECT_NE(result.err.find("0.001"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(metric), std::string::npos) << result.err;
        EXPECT_NE(result.out.find("Hausdorff"), std::string::npos) << "the report is there";
    }
    EXPECT_EQ(compare({"cube.vdb", "cube.obj", "--fail-above", "0.3"}).status, 0);
    expectError({"cube.vdb", "cube.obj", "--fail-above", "1e-3"}, 4, {"hausdorff"});
}

TEST_F(Compare, ComparesNoMoreThanWhatIsAskedFor) {
    const auto values =
        report({"several.vdb", "several.vdb", "--grid", "heat", "--only", "values"});
    EXPECT_TRUE(values["surfaces"].is_null());
    EXPECT_EQ(values["values"]["voxels"], 1);
    const auto surfaces = report({"cube.vdb", "ball.vdb", "--only", "surfaces", "--cuts", "0"});
    EXPECT_TRUE(surfaces["values"].is_null());
    expectError({"cube.vdb", "cube.obj", "--only", "values"}, 2, {"--only"});
    expectError({"cube.vdb", "ball.vdb", "--only", "values", "--iso", "0.4"}, 2, {"--iso"});
    expectError(
        {"cube.vdb", "ball.vdb", "--only", "values", "--fail-above", "1", "--metric", "angle"}, 2,
        {"angle"});
}

TEST_F(Compare, ReadsTheStandardInput) {
    const RunResult result = compare({"stdin.vdb", "cube.vdb", "--json"},
                                     {.standardInput = (*sFolder / "cube.vdb").string()});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["values"]["maximum"], 0);
    expectError({"stdin.vdb", "stdin.vdb"}, 2, {"stdin.vdb"});
}

TEST_F(Compare, IsTheSameForAnyNumberOfThreads) {
    const RunResult one = compare({"cube.vdb", "fine.vdb", "--json", "--threads", "1"});
    const RunResult four = compare({"cube.vdb", "fine.vdb", "--json", "--threads", "4"});
    EXPECT_EQ(one.status, 0);
    EXPECT_EQ(one.out, four.out);
}

TEST_F(Compare, RefusesWhatItCannotCompare) {
    expectError({"empty.vdb", "cube.vdb"}, 3, {"no active voxel"});
    expectError({"cube.vdb", "empty.vdb"}, 3, {"no active voxel"});
    expectError({"empty.vdb", "empty.vdb", "--only", "values"}, 4, {"nothing to compare"});
    expectError({"cube.vdb", "ball.vdb", "--iso", "3"}, 4, {"empty"});
    expectError({"cube.vdb", "missing.vdb"}, 3, {"missing.vdb"});
    expectError({"cube.vdb", "missing.obj"}, 3, {"missing.obj"});
    expectError({"cube.vdb", "shape:cube"}, 3, {"bandvox convert shape:cube"});
    expectError({"cube.vdb"}, 2, {"B"});
    expectError({"cube.vdb", "ball.vdb", "--metric", "max"}, 2, {"--fail-above"});
    expectError({"cube.vdb", "ball.vdb", "--metric", "best", "--fail-above", "1"}, 2, {"'best'"});
    expectError({"cube.vdb", "cube.obj", "--metric", "rms", "--fail-above", "1"}, 2, {"mesh"});
    expectError({"cube.vdb", "ball.vdb", "--fail-above", "-1"}, 2, {"--fail-above"});
    expectError({"cube.vdb", "ball.vdb", "--grid", "heat"}, 3, {"'heat'"});
}

}  // namespace
}  // namespace bandvox::app_test
