// Asking the command to stop in the middle of its work.

#include "build_places.h"
#include "run_command.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

/// Sends `signal` once the first stage has begun.
RunOptions interruptIn(const TemporaryFolder& folder, int signal) {
    RunOptions options{.folder = folder.path()};
    options.signalWhen = [signal](const std::string& said) {
        return said.find("Progress: ") != std::string::npos ? signal : 0;
    };
    return options;
}

/// Work of several seconds on one thread.
const Names kLongConvert{"convert",      "shape:tree", "-o",        "out.vdb",
                         "--resolution", "1200",       "--threads", "1",
                         "--progress",   "always",     "--stats",   "s.json"};

TEST(Interrupt, ConvertLeavesNothing) {
    for (const auto& [signal, status] :
         {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}, std::pair{SIGHUP, 129}}) {
        const TemporaryFolder folder;
        const RunResult result = runBandvox(kLongConvert, interruptIn(folder, signal));
        EXPECT_TRUE(result.signalSent);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: error: interrupted"), 1) << result.err;
        EXPECT_EQ(countLines(result.err, "Progress: 100%"), 0) << result.err;
        EXPECT_EQ(folder.contents(), Names{});
    }
}

TEST(Interrupt, ConvertKeepsAnOlderOutput) {
    const TemporaryFolder folder;
    writeText(folder / "out.vdb", "older");
    const RunResult result = runBandvox(kLongConvert, interruptIn(folder, SIGINT));
    EXPECT_EQ(result.status, 130) << result.err;
    EXPECT_EQ(folder.contents(), Names{"out.vdb"});
    EXPECT_EQ(readText(folder / "out.vdb"), "older");
}

TEST(Interrupt, RenderLeavesNothing) {
    const TemporaryFolder folder;
    ASSERT_EQ(
        runBandvox({"convert", "shape:torus", "-o", "t.vdb", "-r", "64"}, {.folder = folder.path()})
            .status,
        0);
    const RunResult result =
        runBandvox({"render", "t.vdb", "-o", "t.png", "--res", "4000x4000", "--samples", "4",
                    "--threads", "1", "--progress", "always"},
                   interruptIn(folder, SIGINT));
    EXPECT_TRUE(result.signalSent);
    EXPECT_EQ(result.status, 130) << result.err;
    EXPECT_EQ(folder.contents(), Names{"t.vdb"});
}

TEST(Interrupt, SecondSignalEndsAtOnceAndLeavesNothing) {
#ifdef BANDVOX_THREAD_SANITIZER
    GTEST_SKIP() << "the thread sanitizer holds signals back while open() waits";
#endif
    // Nobody reads the pipe: with its output written, the command waits until somebody does.
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    RunOptions options{.folder = folder.path()};
    options.signalUntilItEnds = true;
    options.signalWhen = [&](const std::string&) {
        return folder.contents().size() > 1 ? SIGINT : 0;
    };
    const RunResult result = runBandvox(
        {"convert", "shape:cube", "-o", "out.vdb", "-r", "16", "--stats", "pipe"}, options);
    EXPECT_TRUE(result.signalSent);
    EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
    EXPECT_EQ(folder.contents(), Names{"pipe"});
}

TEST(Interrupt, IgnoredSignalStaysIgnored) {
    // As nohup starts it.
    const TemporaryFolder folder;
    const RunResult result = runProgram(
        {"/bin/sh", "-c",
         "trap '' HUP; exec \"$0\" convert shape:torus -o t.vdb -r 128 --progress always",
         build_places::command()},
        interruptIn(folder, SIGHUP));
    EXPECT_TRUE(result.signalSent);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(folder.contents(), Names{"t.vdb"});
}

}  // namespace
}  // namespace bandvox::app_test
