// What is left of outputs when the disk is full, a folder is locked or goes away, or the process is
// killed.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <chrono>
#include <random>

namespace bandvox::app_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// A small disk of its own; root alone can have one, and not everywhere.
class SmallDisk {
  public:
    explicit SmallDisk(const fs::path& place) : mPlace(place) {
        fs::create_directories(place);
        mMounted = mount("tmpfs", place.c_str(), "tmpfs", 0, "size=1m") == 0;
    }
    ~SmallDisk() {
        if (mMounted) umount2(mPlace.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    bool mounted() const { return mMounted; }

  private:
    fs::path mPlace;
    bool mMounted = false;
};

class Trust : public testing::Test {
  protected:
    Trust() {
        for (const char* name : {"in.1.obj", "in.2.obj", "in.3.obj"}) {
            writeText(mFolder / name, cubeObj());
        }
        fs::create_directory(mFolder / "out");
    }

    Names outputs() const {
        Names names;
        for (const auto& entry : fs::directory_iterator(mFolder / "out")) {
            names.push_back(entry.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

    /// Commands whose output is above a few hundred kilobytes, and what may be left of each.
    static std::vector<std::pair<Names, Names>> largeOutputs() {
        const Names large{"-r", "100", "--compression", "none"};
        const auto with = [](Names command, const Names& more) {
            command.insert(command.end(), more.begin(), more.end());
            return command;
        };
        return {
            {with({"convert", "in.1.obj", "-o", "out/a.vdb"}, large), {}},
            {with({"convert", "in.1.obj", "-o", "out/a.vdb", "--lod", "1"}, large), {}},
            {with({"convert", "in.#.obj", "-o", "out/a.#.vdb", "--keep-going"}, large), {}},
            {{"convert", "in.1.obj", "-o", "out/a.obj", "--voxel-size", "0.02"}, {}},
            {with({"convert", "in.1.obj", "-o", "out/a.vdb", "--stats", "out/s.json"}, large), {}},
        };
    }

    TemporaryFolder mFolder;
};

TEST_F(Trust, AFullDiskLeavesTheOldFileAlone) {
    const SmallDisk disk(mFolder / "out");
    if (!disk.mounted()) GTEST_SKIP() << "no disk can be made here";
    for (const auto& [command, left] : largeOutputs()) {
        for (const char* name : {"out/a.vdb", "out/a.1.vdb", "out/a.obj", "out/s.json"}) {
            writeText(mFolder / name, "older");
        }
        const Names before = outputs();
        const RunResult result = runBandvox(command, {.folder = mFolder.path()});
        SCOPED_TRACE(testing::PrintToString(command) + result.err);
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.err.find("No space left"), std::string::npos);
        EXPECT_EQ(outputs(), before);
        for (const std::string& name : before) {
            EXPECT_EQ(readText(mFolder / "out" / name), "older") << name;
        }
    }
}

TEST_F(Trust, FramesBeforeTheDiskIsFullAreWhole) {
    const SmallDisk disk(mFolder / "out");
    if (!disk.mounted()) GTEST_SKIP() << "no disk can be made here";
    // There is room for two of three.
    const RunResult result = runBandvox({"convert", "in.#.obj", "-o", "out/a.#.vdb", "-r", "50"},
                                        {.folder = mFolder.path()});
    EXPECT_EQ(result.status, 1) << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: error: frame "), 1) << result.err;
    const Names whole = outputs();
    EXPECT_FALSE(whole.empty()) << result.err;
    for (const std::string& name : whole) {
        EXPECT_EQ(runBandvox({"info", (mFolder / "out" / name).string()}).status, 0) << name;
    }
}

TEST_F(Trust, AFileThatMayNotGrowIsLikeAFullDisk) {
    for (const auto& [command, left] : largeOutputs()) {
        const RunResult result =
            runBandvox(command, {.folder = mFolder.path(), .largestFile = 100000});
        SCOPED_TRACE(testing::PrintToString(command) + result.err);
        EXPECT_EQ(result.status, 1);
        EXPECT_GE(countLines(result.err, "bandvox: error: "), 1);
        EXPECT_EQ(outputs(), left);
    }
}

TEST_F(Trust, ALockedFolderIsFoundOutBeforeTheWork) {
    fs::permissions(mFolder / "out", fs::perms::owner_read | fs::perms::owner_exec);
    for (const auto& [command, left] : largeOutputs()) {
        const RunResult result =
            runBandvox(command, {.folder = mFolder.path(), .heedPermissions = true});
        SCOPED_TRACE(testing::PrintToString(command) + result.err);
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.err.find("Permission denied"), std::string::npos);
        EXPECT_EQ(result.err.find("grid     "), std::string::npos);
        EXPECT_EQ(outputs(), left);
    }
}

TEST_F(Trust, AFolderThatGoesAwayIsAnError) {
    for (const auto& [command, left] : largeOutputs()) {
        fs::create_directories(mFolder / "out");
        RunOptions options{.folder = mFolder.path()};
        options.signalWhen = [&](const std::string& said) {
            // The command may put a file there at the same moment; then it is tried again.
            std::error_code again;
            if (said.find("Progress: ") != std::string::npos)
                fs::remove_all(mFolder / "out", again);
            return 0;
        };
        const RunResult result = runBandvox(command, options);
        SCOPED_TRACE(testing::PrintToString(command) + result.err);
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.err.find("cannot write out/"), std::string::npos);
        EXPECT_FALSE(fs::exists(mFolder / "out"));
        EXPECT_EQ(mFolder.contents(), (Names{"in.1.obj", "in.2.obj", "in.3.obj"}));
    }
}

/// Kills a command again and again, at moments spread over the time that it takes.
class Kill : public testing::Test {
  protected:
    using Clock = std::chrono::steady_clock;
    static constexpr int kMoments = 25;

    Kill() {
        const RunResult result =
            runBandvox({"convert", "shape:tree", "-o", "in.vdb", "-r", "200", "--quiet"}, mHere);
        EXPECT_EQ(result.status, 0) << result.err;
        fs::create_directory(mFolder / "out");
    }

    /// Runs a command that replaces out/`name`, and kills it after `part` of `whole`.
    void killAfter(const Names& command, double part, Clock::duration whole) {
        RunOptions options = mHere;
        const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(part * whole);
        options.signalWhen = [end](const std::string&) {
            return Clock::now() >= end ? SIGKILL : 0;
        };
        runBandvox(command, options);
    }

    /// Expects the older or the newer file under its name, whole, and at most one other, whose
    /// name says what it is. Returns how many others there are.
    int expectWhole(const std::string& name, const Names& contents) {
        int others = 0;
        bool isThere = false;
        for (const auto& entry : fs::directory_iterator(mFolder / "out")) {
            const std::string found = entry.path().filename().string();
            if (found == name) {
                const std::string content = readText(entry.path());
                // OpenVDB gives each .vdb file an identity.
                const bool hasIdentity = found.ends_with(".vdb");
                isThere = std::any_of(contents.begin(), contents.end(), [&](std::string known) {
                    std::string now = content;
                    if (hasIdentity && now.size() > 60) now.erase(20, 40);
                    if (hasIdentity) known.erase(20, 40);
                    return now == known;
                });
                EXPECT_TRUE(isThere) << name << " has " << content.size() << " bytes";
            } else {
                EXPECT_TRUE(found.starts_with(".bandvox-")) << found;
                EXPECT_EQ(entry.path().extension(), fs::path(name).extension()) << found;
                ++others;
            }
        }
        EXPECT_TRUE(isThere);
        EXPECT_LE(others, 1);
        return others;
    }

    void killAtManyMoments(const std::string& name, Names older, Names newer) {
        const fs::path target = mFolder / "out" / name;
        ASSERT_EQ(runBandvox(older, mHere).status, 0);
        const std::string before = readText(target);
        const auto start = Clock::now();
        ASSERT_EQ(runBandvox(newer, mHere).status, 0);
        const auto whole = Clock::now() - start;
        const std::string after = readText(target);
        ASSERT_NE(before, after);

        std::mt19937 generator(7);
        std::uniform_real_distribution<double> parts(0, 1.1);
        for (int i = 0; i < kMoments; ++i) {
            writeText(target, before);
            const double part = parts(generator);
            SCOPED_TRACE(name + " after " + std::to_string(part));
            killAfter(newer, part, whole);
            expectWhole(name, {before, after});
        }
        // The next run clears up after them all.
        ASSERT_EQ(runBandvox(newer, mHere).status, 0);
        EXPECT_EQ(expectWhole(name, {after}), 0);
    }

    TemporaryFolder mFolder;
    RunOptions mHere{.folder = mFolder.path()};
};

TEST_F(Kill, AVolumeIsTheOlderOrTheNewer) {
    // Slow to pack, so that many moments fall into the writing.
    killAtManyMoments("a.vdb", {"convert", "shape:cube", "-o", "out/a.vdb", "-r", "16"},
                      {"convert", "in.vdb", "-o", "out/a.vdb", "--compression", "zip"});
}

TEST_F(Kill, AMeshIsTheOlderOrTheNewer) {
    killAtManyMoments("a.obj", {"convert", "shape:cube", "-o", "out/a.obj", "-r", "16"},
                      {"convert", "in.vdb", "-o", "out/a.obj"});
}

TEST_F(Kill, FramesAreWholeOrNotThere) {
    for (const char* name : {"f.1.vdb", "f.2.vdb", "f.3.vdb", "f.4.vdb"}) {
        fs::copy(mFolder / "in.vdb", mFolder / name);
    }
    const Names command{"convert", "f.#.vdb", "-o", "out/f.#.vdb", "--skip-existing"};
    const auto start = Clock::now();
    ASSERT_EQ(runBandvox(command, mHere).status, 0);
    const auto whole = Clock::now() - start;
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> parts(0, 1.1);
    for (int i = 0; i < kMoments; ++i) {
        fs::remove_all(mFolder / "out");
        fs::create_directory(mFolder / "out");
        killAfter(command, parts(generator), whole);
        int others = 0;
        for (const auto& entry : fs::directory_iterator(mFolder / "out")) {
            const std::string found = entry.path().filename().string();
            if (found.starts_with(".bandvox-")) {
                ++others;
            } else {
                EXPECT_EQ(runBandvox({"info", entry.path().string()}).status, 0) << found;
            }
        }
        EXPECT_LE(others, 1);
    }
    // What was done is left as it is, the rest is done.
    std::size_t done = 0;
    for (const auto& entry : fs::directory_iterator(mFolder / "out")) {
        done += entry.path().filename().string().starts_with("f.") ? 1 : 0;
    }
    const RunResult result = runBandvox(command, mHere);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "skipped  "), static_cast<int>(done)) << result.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(mFolder / "out"), fs::directory_iterator()), 4);
}

}  // namespace
}  // namespace bandvox::app_test
