// Options that come from a file.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class Config : public testing::Test {
  protected:
    RunResult run(Names arguments, const std::string& config) {
        writeText(mFolder / "farm.cfg", config);
        arguments.insert(arguments.end(), {"--config", "farm.cfg"});
        return runBandvox(arguments, {.folder = mFolder.path()});
    }

    /// Expects that a file is refused with words, and nothing written.
    void expectRefused(const std::string& config, const Names& words) {
        const RunResult result = run({"convert", "shape:cube", "-o", "refused.vdb"}, config);
        SCOPED_TRACE(config + result.err);
        EXPECT_EQ(result.status, 2);
        EXPECT_EQ(countLines(result.err, ""), 1);
        for (const std::string& word : words) {
            EXPECT_NE(result.err.find(word), std::string::npos) << word;
        }
        EXPECT_FALSE(std::filesystem::exists(mFolder / "refused.vdb"));
    }

    nlohmann::json info(const std::string& name) {
        const RunResult result = runBandvox({"info", name, "--json"}, {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 0) << result.err;
        return nlohmann::json::parse(result.out);
    }

    TemporaryFolder mFolder;
};

TEST_F(Config, GivesOptionsAndTheLineWins) {
    const std::string config =
        "# a comment\n\n  resolution =  16   # along the longest side\norder=3\r\nhalf = true\n"
        "clamp = false\nthreads = 1";
    ASSERT_EQ(run({"convert", "shape:cube", "-o", "a.vdb"}, config).status, 0);
    nlohmann::json grid = info("a.vdb")["grids"][0];
    EXPECT_EQ(grid["voxel_size"][0], 2.0 / 16);
    EXPECT_EQ(grid["bandvox"]["order"], 3);
    EXPECT_TRUE(grid["half"]);
    EXPECT_FALSE(grid["bandvox"]["clamped"]);

    ASSERT_EQ(
        run({"convert", "shape:cube", "-o", "b.vdb", "-r", "20", "--half=false", "--clamp=true"},
            config)
            .status,
        0);
    grid = info("b.vdb")["grids"][0];
    EXPECT_EQ(grid["voxel_size"][0], 2.0 / 20);
    EXPECT_FALSE(grid["half"]);
    EXPECT_TRUE(grid["bandvox"]["clamped"]);
}

TEST_F(Config, AnOptionOnTheLinePutsAsideWhatItRulesOut) {
    ASSERT_EQ(run({"convert", "shape:cube", "-o", "a.vdb", "--voxel-size", "0.25"},
                  "resolution = 64\nquiet = true\n")
                  .status,
              0);
    EXPECT_EQ(info("a.vdb")["grids"][0]["voxel_size"][0], 0.25);
    const RunResult verbose =
        run({"convert", "shape:cube", "-o", "a.vdb", "-r", "16", "-v"}, "quiet = true\n");
    EXPECT_EQ(verbose.status, 0) << verbose.err;
    // Within a file neither wins.
    expectRefused("resolution = 64\nvoxel-size = 0.1\n", {"--resolution", "--voxel-size"});
}

TEST_F(Config, IsForEveryCommand) {
    ASSERT_EQ(run({"convert", "shape:cube"}, "output = c.vdb\nresolution = 16\n").status, 0);
    ASSERT_EQ(run({"voxelize", "shape:cube"}, "output = v.vdb\nresolution = 8\n").status, 0);
    ASSERT_EQ(run({"render", "c.vdb"}, "output = c.##.png\nres = 16x12\nturntable = 2\n").status,
              0);
    EXPECT_TRUE(std::filesystem::exists(mFolder / "c.02.png"));
    ASSERT_EQ(run({"view", "c.vdb"}, "output = c.html\n").status, 0);
    const RunResult info = run({"info", "c.vdb"}, "json = true\n");
    ASSERT_EQ(info.status, 0) << info.err;
    EXPECT_TRUE(nlohmann::json::parse(info.out).contains("grids"));
}

TEST_F(Config, SaysWhereWhatIsWrong) {
    expectRefused("\n\nresolutoin = 5\n", {"farm.cfg:3:", "'resolutoin'", "'--resolution'"});
    expectRefused("samples = 5\n", {"farm.cfg:1:", "'samples'", "'convert'"});
    expectRefused("# c\nresolution = five\n", {"farm.cfg:2:", "'five'", "whole number"});
    expectRefused("compression = lzma\n", {"farm.cfg:1:", "'lzma'", "blosc"});
    expectRefused("cutoff = 0.9\n", {"farm.cfg:1:", "'0.9'", "at most 0.5"});
    expectRefused("half = yes\n", {"farm.cfg:1:", "'yes'", "true or false"});
    expectRefused("half\n", {"farm.cfg:1:", "'half'", "name = value"});
    expectRefused("resolution =\n", {"farm.cfg:1:", "resolution", "not empty"});
    expectRefused("order = 2\norder = 2\n", {"farm.cfg:2:", "order", "line 1"});
    expectRefused("[convert]\nresolution = 5\n", {"farm.cfg:1:", "section"});
    expectRefused("--resolution = 5\n", {"farm.cfg:1:", "'--resolution'"});
}

TEST_F(Config, IsNeitherNestedNorRepeated) {
    expectRefused("config = other.cfg\n", {"farm.cfg:1:", "config"});
    expectRefused("help = true\n", {"farm.cfg:1:", "help"});
    const RunResult twice = run({"info", "a.vdb", "--config", "a.cfg"}, "json = true\n");
    EXPECT_EQ(twice.status, 2);
    EXPECT_NE(twice.err.find("--config"), std::string::npos) << twice.err;
}

TEST_F(Config, HasToBeThere) {
    for (const std::string name : {"none.cfg", "."}) {
        const RunResult result =
            runBandvox({"info", "a.vdb", "--config", name}, {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 3) << result.err;
        EXPECT_NE(result.err.find("'" + name + "'"), std::string::npos) << result.err;
    }
}

TEST_F(Config, FlagsOnTheLineAreTrueOrFalse) {
    const auto status = [&](const Names& options) {
        Names arguments{"convert", "shape:cube", "-o", "f.vdb", "-r", "16"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return runBandvox(arguments, {.folder = mFolder.path()}).status;
    };
    EXPECT_EQ(status({"--half=true"}), 0);
    EXPECT_TRUE(info("f.vdb")["grids"][0]["half"]);
    EXPECT_EQ(status({"--half=false"}), 0);
    EXPECT_FALSE(info("f.vdb")["grids"][0]["half"]);
    EXPECT_EQ(status({"--half=yes"}), 2);
    EXPECT_EQ(status({"--half", "--half=false"}), 2);
    EXPECT_EQ(status({"--half=false", "--half=false"}), 2);
    EXPECT_EQ(status({"--resolution=true"}), 2);
}

}  // namespace
}  // namespace bandvox::app_test
