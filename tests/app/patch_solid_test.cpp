// What convert makes of free-form surfaces, and which it refuses.

#include "build_places.h"
#include "run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace bandvox::app_test {
namespace {

const std::string kTeapotBpt =
    (std::filesystem::path(build_places::sources()) / "examples" / "data" / "teapot.bpt").string();

// A quarter of a cylinder's mantle, rational, of degrees 2 and 1.
const std::string kQuarter =
    "v 1 0 0\nv 1 1 0 0.7071067811865476\nv 0 1 0\nv 1 0 2\nv 1 1 2 0.7071067811865476\nv 0 1 2\n"
    "cstype rat bezier\ndeg 2 1\nsurf 0 1 0 1 1 2 3 4 5 6\nparm u 0 1\nparm v 0 1\nend\n";

TEST(PatchSolidCommand, FillsTheTeapotWhateverTheNumberOfThreads) {
    const TemporaryFolder folder;
    const RunResult one = runBandvox({"convert", kTeapotBpt, "-o", "one.vdb", "-r", "24",
                                      "--threads", "1", "--stats", "stats.json"},
                                     {.folder = folder.path()});
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_NE(one.err.find("6 holes capped"), std::string::npos) << one.err;
    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    EXPECT_EQ(stats["counts"]["patches"], 32);
    EXPECT_EQ(stats["counts"]["holes_capped"], 6);
    ASSERT_EQ(runBandvox({"convert", kTeapotBpt, "-o", "two.vdb", "-r", "24", "--threads", "2"},
                         {.folder = folder.path()})
                  .status,
              0);
    const RunResult same = runBandvox({"compare", "one.vdb", "two.vdb", "--only", "values",
                                       "--metric", "max", "--fail-above", "0"},
                                      {.folder = folder.path()});
    EXPECT_EQ(same.status, 0) << same.err;
}

TEST(PatchSolidCommand, MakesTheSolidThatFitMakes) {
    const TemporaryFolder folder;
    std::string heights = "x,y,z\n";
    for (int i = 0; i <= 12; ++i) {
        for (int j = 0; j <= 10; ++j) {
            heights += std::to_string(0.25 * i) + "," + std::to_string(0.2 * j) + "," +
                       std::to_string(1 + 0.02 * i * (j % 4)) + "\n";
        }
    }
    writeText(folder / "heights.csv", heights);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"fit", "heights.csv", "-o", "s.bpt"},
          {"fit", "heights.csv", "-o", "a.vdb", "--base", "0", "--voxel-size", "0.1"},
          {"convert", "s.bpt", "-o", "b.vdb", "--base", "0", "--voxel-size", "0.1"},
          {"compare", "a.vdb", "b.vdb", "--only", "values", "--metric", "max", "--fail-above",
           "2e-5"}}) {
        const RunResult result = runBandvox(arguments, {.folder = folder.path()});
        EXPECT_EQ(result.status, 0) << arguments[0] << ": " << result.err;
    }
}

TEST(PatchSolidCommand, RefusesWhatItCannotFill) {
    const TemporaryFolder folder;
    writeText(folder / "broken.bpt", "1\n3 3\n0 0 0\n");
    writeText(folder / "flat.bpt", "1\n1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
    writeText(folder / "quarter.obj", kQuarter);
    const auto statusOf = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "convert");
        arguments.insert(arguments.end(), {"-o", "x.vdb", "-r", "16"});
        return runBandvox(arguments, {.folder = folder.path()}).status;
    };
    EXPECT_EQ(statusOf({"quarter.obj"}), 0);
    EXPECT_EQ(statusOf({"broken.bpt"}), 3);
    EXPECT_EQ(statusOf({"missing.bpt"}), 3);
    EXPECT_EQ(statusOf({"flat.bpt"}), 4);
    EXPECT_EQ(statusOf({"flat.bpt", "--base", "-1"}), 0);
    EXPECT_EQ(statusOf({"flat.bpt", "--base", "1"}), 2);
    EXPECT_EQ(statusOf({kTeapotBpt, "--base", "-1"}), 2);
    EXPECT_EQ(statusOf({"shape:cube", "--base", "-1"}), 2);
    EXPECT_EQ(statusOf({kTeapotBpt, "--route", "winding"}), 2);
    EXPECT_EQ(statusOf({kTeapotBpt, "--color"}), 2);
    EXPECT_EQ(statusOf({kTeapotBpt, "--strict"}), 3);
}

}  // namespace
}  // namespace bandvox::app_test
