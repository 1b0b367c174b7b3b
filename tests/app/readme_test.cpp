// The lines that README.md shows work as they stand.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

#include <sstream>

namespace bandvox::app_test {
namespace {

namespace fs = std::filesystem;

/// The blocks fenced as "```sh runnable", in order.
std::vector<std::string> runnableBlocks(const std::string& text) {
    std::vector<std::string> blocks;
    bool inside = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (inside && line == "```") {
            inside = false;
        } else if (inside) {
            blocks.back() += line + '\n';
        } else if (line == "```sh runnable") {
            inside = true;
            blocks.emplace_back();
        }
    }
    return blocks;
}

TEST(Readme, RunnableBlocksRun) {
    const std::vector<std::string> blocks =
        runnableBlocks(readText(fs::path(BANDVOX_SOURCE_DIR) / "README.md"));
    ASSERT_GE(blocks.size(), 5u);
    const TemporaryFolder folder;
    writeText(folder / "bunny.obj", cubeObj());
    writeText(folder / "painted.obj", coloredCubeObj());
    const std::string path =
        "PATH=" + fs::path(BANDVOX_EXECUTABLE).parent_path().string() + ":$PATH\n";
    for (const std::string& block : blocks) {
        const RunResult result =
            runProgram({"/bin/sh", "-e", "-c", path + block}, {.folder = folder.path()});
        EXPECT_EQ(result.status, 0) << block << result.err;
    }
    for (const char* name :
         {"bunny.vdb", "bunny.png", "bunny.exr", "bunny.json", "sharp.vdb", "voxels.png",
          "small.vdb", "levels.vdb", "piped.png", "painted.vdb", "bunny.ply", "painted.glb",
          "soft.png", "fog.png", "around.03.png", "sim.0002.vdb", "again.vdb"}) {
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
}

TEST(Readme, NamesOnlyFilesThatAreThere) {
    const fs::path root = BANDVOX_SOURCE_DIR;
    for (const char* document : {"README.md", "CONTRIBUTING.md"}) {
        const std::string text = readText(root / document);
        ASSERT_FALSE(text.empty());
        int links = 0;
        for (std::size_t at = 0; (at = text.find("](", at)) != std::string::npos;) {
            at += 2;
            const std::string target = text.substr(at, text.find(')', at) - at);
            EXPECT_TRUE(fs::exists(root / target)) << document << " links to " << target;
            ++links;
        }
        for (std::size_t at = 0; (at = text.find("scripts/", at)) != std::string::npos;) {
            const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-/", at);
            const std::string script = text.substr(at, end - at);
            EXPECT_TRUE(fs::exists(root / script)) << document << " names " << script;
            at = end;
            ++links;
        }
        EXPECT_GT(links, 0) << document;
    }
}

}  // namespace
}  // namespace bandvox::app_test
