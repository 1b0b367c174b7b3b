// convert within a limit of memory.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class MemoryLimit : public testing::Test {
  protected:
    RunResult run(const Names& arguments, RunOptions options = {}) {
        options.folder = mFolder.path();
        return runBandvox(arguments, options);
    }

    // A file without the number that makes each another.
    std::string bytesOf(const std::string& name) {
        constexpr std::size_t kBefore = 21, kNumber = 36;
        return readText(mFolder / name).erase(kBefore, kNumber);
    }

    // Converts with and without the limit.
    void expectSame(Names arguments, const std::string& limit, std::int64_t bytes) {
        SCOPED_TRACE(arguments.front());
        arguments.insert(arguments.begin(), "convert");
        arguments.insert(arguments.end(), {"--threads", "2", "-o"});
        Names whole = arguments;
        whole.emplace_back("whole.vdb");
        const RunResult first = run(whole);
        ASSERT_EQ(first.status, 0) << first.err;
        arguments.insert(arguments.end(), {"limited.vdb", "--memory-limit", limit});
        const RunResult second = run(arguments);
        ASSERT_EQ(second.status, 0) << second.err;
        EXPECT_TRUE(bytesOf("whole.vdb") == bytesOf("limited.vdb"));
        EXPECT_EQ(mFolder.contents(), (Names{"limited.vdb", "whole.vdb"}));
#ifndef BANDVOX_SANITIZED
        EXPECT_GT(first.peakBytes, bytes);
        EXPECT_LT(second.peakBytes, bytes);
#endif
    }

    void expectRefused(Names arguments, const std::string& said) {
        arguments.insert(arguments.begin(), "convert");
        arguments.insert(arguments.end(), {"--memory-limit", "1G"});
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, 2) << arguments[1] << " " << result.err;
        EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
    }

    TemporaryFolder mFolder;
};

TEST_F(MemoryLimit, FilesAreTheSameAndTheLimitIsKept) {
    constexpr std::int64_t kLimit = std::int64_t(110) << 20;
    expectSame({"shape:torus", "-r", "500"}, "110M", kLimit);
    expectSame({"shape:cube", "-r", "280", "--order", "4", "--cutoff", "0.25", "--half",
                "--compression", "zip"},
               "110M", kLimit);
}

TEST_F(MemoryLimit, IsRefusedWhereTheWholeIsNeeded) {
    const Names torus{"shape:torus", "-r", "32", "-o"};
    const auto with = [&](Names more) {
        Names all = torus;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    expectRefused(with({"o.vdb", "--iso", "volume"}), "--memory-limit is not for --iso volume");
    expectRefused(with({"o.vdb", "--lod", "2"}), "--memory-limit is not for --lod");
    expectRefused(with({"o.vdb", "--as", "level-set"}), "--memory-limit is not for --as level-set");
    expectRefused(with({"o.vdb", "--shard", "1/2"}), "--memory-limit is not for --shard");
    expectRefused(with({"o.vdb", "--route", "sampled"}),
                  "--memory-limit is not for --route sampled");
    expectRefused(with({"o.nrrd"}), "--memory-limit is not for arrays and images");
    expectRefused(with({"o.ply"}), "becomes a .vdb file");
    expectRefused(with({"stdout.vdb"}), "a pipe or a device");
    writeText(mFolder / "cube.obj", coloredCubeObj());
    expectRefused({"cube.obj", "-o", "o.vdb", "--color"}, "--memory-limit is not for --color");
    writeText(mFolder / "points.xyz", "0 0 0\n1 0 0\n");
    expectRefused({"points.xyz", "-o", "o.vdb", "--radius", "1"}, "becomes a .vdb file");
    EXPECT_EQ(mFolder.contents(), (Names{"cube.obj", "points.xyz"}));
}

TEST_F(MemoryLimit, WantsASize) {
    for (const char* size : {"", "2", "G", "2X", "-1G", "2GB", "nan", "1e30G"}) {
        const RunResult result =
            run({"convert", "shape:torus", "-o", "o.vdb", "--memory-limit", size});
        EXPECT_EQ(result.status, 2) << size << result.err;
    }
}

TEST_F(MemoryLimit, ThatIsTooLowIsAnError) {
    const RunResult result =
        run({"convert", "shape:torus", "-r", "200", "-o", "o.vdb", "--memory-limit", "2M"});
    EXPECT_EQ(result.status, 5) << result.err;
    EXPECT_NE(result.err.find("limit of 2"), std::string::npos) << result.err;
    EXPECT_EQ(mFolder.contents(), Names{});
}

// Sharp filters take large tiles and many samples.
TEST_F(MemoryLimit, IsKeptByLargeTiles) {
    const Names sharp{"convert", "shape:torus", "-o",        "o.vdb", "-r",      "150",
                      "--order", "64",          "--threads", "2",     "--cutoff"};
    const auto limited = [&](const char* cutoff, const char* limit) {
        Names arguments = sharp;
        arguments.insert(arguments.end(), {cutoff, "--memory-limit", limit});
        return run(arguments);
    };
    const RunResult refused = limited("0.3", "200M");
    EXPECT_EQ(refused.status, 5) << refused.err;
    const RunResult made = limited("0.5", "600M");
    EXPECT_EQ(made.status, 0) << made.err;
#ifndef BANDVOX_SANITIZED
    EXPECT_LT(refused.peakBytes, std::int64_t(200) << 20);
    EXPECT_LT(made.peakBytes, std::int64_t(600) << 20);
#endif
}

TEST_F(MemoryLimit, LeavesNothingWhereTheDiskIsFull) {
    const RunResult result = run({"convert", "shape:torus", "-r", "500", "-o", "o.vdb", "--threads",
                                  "2", "--memory-limit", "110M"},
                                 {.largestFile = 1'000'000});
    EXPECT_EQ(result.status, 1) << result.err;
    EXPECT_NE(result.err.find("cannot write o.vdb, in a temporary file beside it"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(mFolder.contents(), Names{});
}

TEST_F(MemoryLimit, LeavesNothingWhenInterrupted) {
    // Where a part is on the disk already.
    RunOptions options;
    options.signalWhen = [](const std::string& said) {
        constexpr int kEnough = 25;
        const std::string word = "Progress: ";
        const std::size_t last = said.rfind(word);
        return last != std::string::npos && std::atoi(said.c_str() + last + word.size()) > kEnough
                   ? SIGINT
                   : 0;
    };
    const RunResult result =
        run({"convert", "shape:torus", "-r", "1000", "-o", "o.vdb", "--threads", "1",
             "--memory-limit", "130M", "--progress", "always"},
            options);
    EXPECT_TRUE(result.signalSent);
    EXPECT_EQ(result.status, 130) << result.err;
    EXPECT_EQ(mFolder.contents(), Names{});
}

TEST_F(MemoryLimit, IsNoSettingOfWhatIsMade) {
    const Names convert{"convert", "shape:torus", "-r", "48", "-o", "o.vdb", "--skip-existing"};
    ASSERT_EQ(run(convert).status, 0);
    Names again = convert;
    again.insert(again.end(), {"--memory-limit", "1G"});
    const RunResult result = run(again);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "skipped"), 1) << result.err;
}

}  // namespace
}  // namespace bandvox::app_test
