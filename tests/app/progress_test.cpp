// How far the work is, as it is shown on a terminal and to a program that reads along.

#include "build_places.h"
#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

#include <sstream>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

/// The percentages that were printed, in order. Expects each to be a line of its own.
std::vector<int> percentsIn(const std::string& said) {
    std::vector<int> percents;
    std::istringstream lines(said);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("Progress") == std::string::npos) continue;
        int percent = -1;
        char sign = 0;
        EXPECT_EQ(std::sscanf(line.c_str(), "Progress: %d%c", &percent, &sign), 2) << line;
        EXPECT_EQ(line, "Progress: " + std::to_string(percent) + "%");
        percents.push_back(percent);
    }
    return percents;
}

void expectRising(const std::vector<int>& percents) {
    ASSERT_FALSE(percents.empty());
    EXPECT_GE(percents.front(), 0);
    for (std::size_t i = 1; i < percents.size(); ++i) EXPECT_GT(percents[i], percents[i - 1]);
}

TEST(Progress, GoesUpToAHundredWithoutATerminal) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", cubeObj());
    const std::vector<Names> commands{
        {"convert", "shape:tree", "-o", "t.vdb", "-r", "300", "--lod", "2", "--threads", "1"},
        {"convert", "cube.obj", "-o", "cube.ply", "-r", "64"},
        {"convert", "t.vdb", "-o", "small.vdb", "--factor", "2"},
        {"convert", "t.vdb", "-o", "t.ply"},
        {"voxelize", "cube.obj", "-o", "voxels.vdb", "-r", "64"},
        {"render", "small.vdb", "-o", "t.##.png", "--res", "200x200", "--turntable", "2"},
        {"view", "small.vdb", "-o", "t.html"},
        {"info", "t.vdb", "--progress", "always"}};
    for (const Names& command : commands) {
        const RunResult result = runBandvox(command, {.folder = folder.path()});
        SCOPED_TRACE(testing::PrintToString(command) + result.err);
        ASSERT_EQ(result.status, 0);
        const std::vector<int> percents = percentsIn(result.err);
        expectRising(percents);
        EXPECT_EQ(percents.back(), 100);
        EXPECT_LE(percents.front(), 60);
    }
}

TEST(Progress, SpansAllFrames) {
    const TemporaryFolder folder;
    for (const char* name : {"a.1.obj", "a.2.obj", "a.3.obj", "a.4.obj"}) {
        writeText(folder / name, cubeObj());
    }
    // Each frame takes longer than it takes until another line may be printed.
    const RunResult result = runBandvox(
        {"convert", "a.#.obj", "-o", "a.#.vdb", "-r", "400", "--threads", "1", "--lod", "1"},
        {.folder = folder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::vector<int> percents = percentsIn(result.err);
    expectRising(percents);
    EXPECT_EQ(percents.back(), 100);
    // When a frame begins, those before it are done, and it is not.
    std::istringstream lines(result.err);
    int frame = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("frame ")) ++frame;
        if (!line.starts_with("Progress: ") || line == "Progress: 100%") continue;
        EXPECT_GE(percentsIn(line).front(), 25 * (frame - 1)) << result.err;
        EXPECT_LE(percentsIn(line).front(), 25 * frame) << result.err;
    }
}

TEST(Progress, IsNotAtAHundredWithoutSuccess) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", cubeObj());
    const RunResult full = runBandvox({"convert", "cube.obj", "-o", "cube.vdb", "-r", "64"},
                                      {.folder = folder.path(), .largestFile = 1000});
    EXPECT_EQ(full.status, 1);
    for (const int percent : percentsIn(full.err)) EXPECT_LT(percent, 100) << full.err;
    writeText(folder / "f.1.obj", cubeObj());
    const RunResult part = runBandvox(
        {"convert", "f.#.obj", "-o", "f.#.vdb", "-r", "16", "--frames", "1-2", "--keep-going"},
        {.folder = folder.path()});
    EXPECT_EQ(part.status, 3);
    for (const int percent : percentsIn(part.err)) EXPECT_LT(percent, 100) << part.err;
}

TEST(Progress, IsSilentWhenItIsNotWanted) {
    const TemporaryFolder folder;
    const Names convert{"convert", "shape:cube", "-o", "cube.vdb", "-r", "16"};
    for (const Names& options : {Names{"--quiet"}, {"--progress", "never"}}) {
        Names command = convert;
        command.insert(command.end(), options.begin(), options.end());
        const RunResult result = runBandvox(command, {.folder = folder.path()});
        EXPECT_EQ(result.err.find("Progress"), std::string::npos) << result.err;
    }
    // What only reports is silent of itself.
    EXPECT_EQ(runBandvox({"info", "cube.vdb"}, {.folder = folder.path()}).err, "");
    // Whoever asks for it gets it.
    Names both = convert;
    both.insert(both.end(), {"--quiet", "--progress", "always"});
    const RunResult result = runBandvox(both, {.folder = folder.path()});
    EXPECT_EQ(countLines(result.err, "Progress: "), countLines(result.err, "")) << result.err;
    EXPECT_EQ(percentsIn(result.err).back(), 100);
}

TEST(Progress, IsABarOnATerminal) {
    if (!hasProgram("script")) GTEST_SKIP() << "script, which makes a terminal, is not here";
    const TemporaryFolder folder;
    const RunResult result = runProgram(
        {"script", "-qec",
         std::string(build_places::command()) + " convert shape:cube -o c.vdb -r 16", "/dev/null"},
        {.folder = folder.path()});
    EXPECT_EQ(result.status, 0) << result.out;
    EXPECT_EQ(result.out.find("Progress: "), std::string::npos) << result.out;
    // The line is taken away before anything else is said.
    EXPECT_NE(result.out.find("\r\033[Kwrote"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace bandvox::app_test
