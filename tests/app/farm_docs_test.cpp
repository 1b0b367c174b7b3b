// The lines that docs/farm.md shows work as they stand, and do what it says.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

namespace bandvox::app_test {
namespace {

namespace fs = std::filesystem;

TEST(FarmPage, LinesDoWhatItSays) {
    const std::string page = readText(fs::path(BANDVOX_SOURCE_DIR) / "docs/farm.md");
    const TemporaryFolder folder;
    for (const char* name : {"sim.0001.obj", "sim.0002.obj", "sim.0003.obj"}) {
        writeText(folder / name, cubeObj());
    }
    const std::string path =
        "PATH=" + fs::path(BANDVOX_EXECUTABLE).parent_path().string() + ":$PATH\n";
    const std::string fence = "\n```sh runnable\n";
    std::string said;
    int blocks = 0;
    for (std::size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
        at += fence.size();
        const std::string block = page.substr(at, page.find("\n```", at) + 1 - at);
        const RunResult result =
            runProgram({"/bin/sh", "-e", "-c", path + block}, {.folder = folder.path()});
        EXPECT_EQ(result.status, 0) << block << result.err;
        said += result.err;
        ++blocks;
    }
    EXPECT_EQ(blocks, 6);
    EXPECT_EQ(countLines(said, "skipped  vol.000"), 3) << said;
    EXPECT_EQ(countLines(said, "redo     vol.000"), 3) << said;
    EXPECT_NE(said.find("resolution was 48, is 40"), std::string::npos) << said;
    for (const char* name : {"surface.0003.ply", "coarse.01.vdb", "coarse.03.vdb", "third.vdb",
                             "shot.vdb", "fine.vdb"}) {
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
    EXPECT_FALSE(fs::exists(folder / "coarse.02.vdb"));
}

}  // namespace
}  // namespace bandvox::app_test
