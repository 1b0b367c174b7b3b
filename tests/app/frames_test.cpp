// Sequences of frames by one process.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class Frames : public testing::Test {
  protected:
    Frames() {
        for (const char* name : {"in.0001.obj", "in.0002.obj", "in.0003.obj", "in.0010.obj"}) {
            writeText(mFolder / name, cubeObj());
        }
    }

    RunResult convert(Names arguments, RunOptions options = {}) {
        arguments.insert(arguments.begin(), "convert");
        arguments.insert(arguments.end(), {"-r", "16"});
        options.folder = mFolder.path();
        return runBandvox(arguments, options);
    }

    /// Names of all that is not an input.
    Names outputs() const {
        Names names;
        for (const std::string& name : mFolder.contents()) {
            if (!name.starts_with("in.")) names.push_back(name);
        }
        return names;
    }

    void expectFailure(const Names& arguments, int status, const Names& words) {
        const RunResult result = convert(arguments);
        SCOPED_TRACE(testing::PrintToString(arguments) + result.err);
        EXPECT_EQ(result.status, status);
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1);
        for (const std::string& word : words) {
            EXPECT_NE(result.err.find(word), std::string::npos) << word;
        }
        EXPECT_EQ(outputs(), Names{});
    }

    TemporaryFolder mFolder;
};

TEST_F(Frames, TakesThoseThatAreAskedFor) {
    const RunResult result = convert({"in.####.obj", "-o", "out.##.vdb", "--frames", "1-3x2"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(outputs(), (Names{"out.01.vdb", "out.03.vdb"}));
    // Each as if it were alone, but for the identity that OpenVDB gives to every file.
    ASSERT_EQ(convert({"in.0003.obj", "-o", "alone.vdb"}).status, 0);
    const auto withoutIdentity = [&](const std::string& name) {
        return readText(mFolder / name).erase(20, 40);
    };
    EXPECT_EQ(withoutIdentity("out.03.vdb"), withoutIdentity("alone.vdb"));
}

TEST_F(Frames, TakesAllThatAreThereInOrder) {
    // None of these is a frame of that name.
    for (const char* name : {"in.1.obj", "in.00001.obj", "in..obj", "in.x001.obj", "in.0004.ply"}) {
        writeText(mFolder / name, "no mesh");
    }
    const RunResult result = convert({"in.%04d.obj", "-o", "out.#.ply"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "frames   4 of in.%04d.obj: 1, 2, 3, 10"), 1) << result.err;
    EXPECT_EQ(outputs(), (Names{"out.1.ply", "out.10.ply", "out.2.ply", "out.3.ply"}));
}

TEST_F(Frames, VolumesAndTheirMeshesAreSequencesToo) {
    ASSERT_EQ(convert({"in.####.obj", "-o", "v.####.vdb"}).status, 0);
    RunResult result = runBandvox({"convert", "v.####.vdb", "-o", "s.####.vdb", "--factor", "2"},
                                  {.folder = mFolder.path()});
    EXPECT_EQ(result.status, 0) << result.err;
    result = runBandvox({"convert", "v.####.vdb", "-o", "s.####.obj"}, {.folder = mFolder.path()});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(mFolder / "s.0010.vdb"));
    EXPECT_TRUE(std::filesystem::exists(mFolder / "s.0010.obj"));
}

TEST_F(Frames, NeedsPlacesInBothNames) {
    expectFailure({"in.####.obj", "-o", "out.vdb"}, 2, {"'out.vdb'", "name.####.vdb"});
    expectFailure({"in.0001.obj", "-o", "out.####.vdb"}, 2, {"'in.0001.obj'"});
    expectFailure({"shape:cube", "-o", "out.####.vdb", "--frames", "1-2"}, 2, {"'shape:cube'"});
    expectFailure({"in.0001.obj", "-o", "out.vdb", "--frames", "1"}, 2, {"'in.0001.obj'"});
    expectFailure({"in.####.obj", "-o", "out.####.vdb", "--frames", "3-1"}, 2, {"'3-1'"});
    expectFailure({"in.####.obj", "-o", "in.####.obj"}, 2, {"in.0001.obj", "frame 1"});
    expectFailure({"in.####.obj", "-o", "out.#.vdb", "--stats", "out.10.vdb"}, 2,
                  {"'out.10.vdb'", "frame 10", "--stats"});
    expectFailure({"none.####.obj", "-o", "out.####.vdb"}, 3, {"none.####.obj"});
}

TEST_F(Frames, AMissingFrameIsNamedBeforeAnyIsBegun) {
    expectFailure({"in.####.obj", "-o", "out.####.vdb", "--frames", "1-5"}, 3,
                  {"frame 4", "'in.0004.obj'", "2 of 5", "4, 5", "--keep-going"});
}

TEST_F(Frames, StopsAtTheFirstThatFails) {
    writeText(mFolder / "in.0002.obj", "rubbish");
    const RunResult result = convert({"in.####.obj", "-o", "out.####.vdb", "--stats", "s.json"});
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(countLines(result.err, "bandvox: error: frame 2: "), 1) << result.err;
    EXPECT_EQ(outputs(), Names{"out.0001.vdb"});
}

TEST_F(Frames, GoesOnWithTheOthersIfAskedTo) {
    writeText(mFolder / "in.0002.obj", "rubbish");
    const RunResult result = convert({"in.####.obj", "-o", "out.####.vdb", "--frames", "1-4",
                                      "--keep-going", "--stats", "s.json"});
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(countLines(result.err, "bandvox: error: frame 2: "), 1) << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: error: frame 4: there is no file 'in.0004.obj'"), 1)
        << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: error: 2 of 4 frames failed: 2, 4"), 1)
        << result.err;
    EXPECT_EQ(outputs(), (Names{"out.0001.vdb", "out.0003.vdb", "s.json"}));
    const auto statistics = nlohmann::json::parse(readText(mFolder / "s.json"));
    ASSERT_EQ(statistics["frames"].size(), 4u);
    const Names results{"written", "failed", "written", "failed"};
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(statistics["frames"][i]["frame"], i + 1);
        EXPECT_EQ(statistics["frames"][i]["result"], results[i]);
    }
    EXPECT_EQ(statistics["frames"][1]["exit_status"], 3);
    EXPECT_EQ(statistics["counts"]["frames_failed"], 2);
}

TEST_F(Frames, TheStatusIsThatOfTheFirstFailure) {
    // A surface without a volume is no result; a file that is missing no input.
    writeText(mFolder / "in.0001.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
    const int alone = convert({"in.0001.obj", "-o", "out.vdb"}).status;
    ASSERT_NE(alone, 0);
    const Names both{"in.####.obj", "-o", "out.####.vdb", "--keep-going", "--frames"};
    Names forward = both;
    forward.emplace_back("1-4");
    EXPECT_EQ(convert(forward).status, alone);
    // A wrong option fails all frames alike, so it is said once.
    Names wrong = forward;
    wrong.insert(wrong.end(), {"--cutoff", "9"});
    const RunResult result = convert(wrong);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
}

TEST_F(Frames, WarningsNameTheirFrame) {
    writeText(mFolder / "in.0002.obj", openCubeObj());
    const RunResult strict = convert({"in.####.obj", "-o", "out.####.vdb", "--strict"});
    const RunResult lax = convert({"in.####.obj", "-o", "out.####.vdb"});
    EXPECT_EQ(lax.status, 0) << lax.err;
    EXPECT_GE(countLines(lax.err, "bandvox: warning: frame 2: "), 1) << lax.err;
    EXPECT_NE(strict.status, 0);
    EXPECT_EQ(countLines(strict.err, "bandvox: error: frame 2: "), 1) << strict.err;
}

TEST_F(Frames, StatisticsHaveEachFrame) {
    ASSERT_EQ(convert({"in.####.obj", "-o", "out.####.vdb", "--stats", "s.json"}).status, 0);
    const auto statistics = nlohmann::json::parse(readText(mFolder / "s.json"));
    ASSERT_EQ(statistics["frames"].size(), 4u);
    std::int64_t bytes = 0;
    for (const auto& frame : statistics["frames"]) {
        const auto size = std::filesystem::file_size(mFolder / frame["output"].get<std::string>());
        EXPECT_EQ(frame["counts"]["output_bytes"], size);
        EXPECT_EQ(frame["counts"]["triangles"], 12);
        EXPECT_FALSE(frame["stages"].empty());
        bytes += static_cast<std::int64_t>(size);
    }
    EXPECT_EQ(statistics["frames"][3]["input"], "in.0010.obj");
    EXPECT_EQ(statistics["counts"]["output_bytes"], bytes);
    EXPECT_EQ(statistics["counts"]["frames_written"], 4);
}

TEST_F(Frames, AnInterruptLeavesFinishedFramesWhole) {
    RunOptions options;
    options.signalWhen = [&](const std::string& said) {
        return said.find("frame    2") != std::string::npos ? SIGINT : 0;
    };
    options.folder = mFolder.path();
    const RunResult stopped = runBandvox(
        {"convert", "in.####.obj", "-o", "out.####.vdb", "--voxel-size", "0.005", "--threads", "1"},
        options);
    EXPECT_TRUE(stopped.signalSent);
    EXPECT_EQ(stopped.status, 130) << stopped.err;
    EXPECT_EQ(countLines(stopped.err, "bandvox: error: interrupted"), 1) << stopped.err;
    EXPECT_NE(stopped.err.find("in frame 2, after 1 of 4"), std::string::npos) << stopped.err;
    EXPECT_EQ(outputs(), Names{"out.0001.vdb"});
    EXPECT_EQ(runBandvox({"info", "out.0001.vdb"}, {.folder = mFolder.path()}).status, 0);
}

}  // namespace
}  // namespace bandvox::app_test
