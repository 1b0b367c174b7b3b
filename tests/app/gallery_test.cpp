// The commands of docs/gallery.md work, and make the pictures that it shows; smaller ones, here.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

#include <regex>
#include <sstream>

namespace bandvox::app_test {
namespace {

namespace fs = std::filesystem;

struct Picture {
    std::string name;  // of the file
    std::string commands;
};

// Each picture of the page with the commands under it.
std::vector<Picture> pictures(const std::string& page) {
    std::vector<Picture> found;
    const std::string folder = "](images/gallery/";
    for (std::size_t at = 0; (at = page.find(folder, at)) != std::string::npos;) {
        at += folder.size();
        const std::string fence = "```sh\n";
        const std::size_t begin = page.find(fence, at) + fence.size();
        found.push_back({page.substr(at, page.find(')', at) - at),
                         page.substr(begin, page.find("```", begin) - begin)});
    }
    return found;
}

// The same as a small and coarse picture.
std::string reduced(std::string text) {
    text = std::regex_replace(text, std::regex("--res [0-9]+x[0-9]+"), "--res 24x18");
    text = std::regex_replace(text, std::regex("--samples [0-9]+"), "--samples 1");
    text = std::regex_replace(text, std::regex(" --resolution [0-9]+"), "");
    text = std::regex_replace(text, std::regex("(bandvox convert [^\n]*)"), "$1 --resolution 48");
    text =
        std::regex_replace(text, std::regex("\"res\": \\[[0-9]+, [0-9]+\\]"), "\"res\": [24, 18]");
    return std::regex_replace(text, std::regex("\"samples\": [0-9]+"), "\"samples\": 1");
}

TEST(Gallery, ItsCommandsMakeItsPictures) {
    const fs::path root = BANDVOX_SOURCE_DIR;
    const std::vector<Picture> all = pictures(readText(root / "docs/gallery.md"));
    ASSERT_GE(all.size(), 7u);
    const TemporaryFolder folder;
    for (const auto& entry : fs::directory_iterator(root / "examples/scenes")) {
        const fs::path copy = folder / entry.path().filename().string();
        fs::copy_file(entry.path(), copy);
        if (copy.extension() == ".json") writeText(copy, reduced(readText(copy)));
    }
    // Cubes stand for the meshes that are not part of the project.
    for (const char* mesh : {"stanford-bunny.obj", "teapot.obj", "spot.obj"}) {
        writeText(folder / mesh, cubeObj());
    }
    const bool hasOpenVdb =
        runProgram({"/usr/bin/python3", "-c", "import numpy, pyopenvdb"}).status == 0;
    const std::string path =
        "PATH=" + fs::path(BANDVOX_EXECUTABLE).parent_path().string() + ":$PATH\n";
    int made = 0;
    for (const Picture& picture : all) {
        EXPECT_TRUE(fs::exists(root / "docs/images/gallery" / picture.name)) << picture.name;
        const bool needsOpenVdb = picture.commands.find("./cloud.py") != std::string::npos ||
                                  picture.commands.find("./scan.py") != std::string::npos;
        if (needsOpenVdb && !hasOpenVdb) continue;
        const RunResult result = runProgram(
            {"/bin/sh", "-e", "-c", path + reduced(picture.commands)}, {.folder = folder.path()});
        EXPECT_EQ(result.status, 0) << picture.commands << result.err;
        EXPECT_TRUE(fs::exists(folder / picture.name)) << picture.name;
        ++made;
    }
    EXPECT_GE(made, 5);
}

TEST(Gallery, ThePageAboutRenderingShowsASceneThatIsOne) {
    const std::string page = readText(fs::path(BANDVOX_SOURCE_DIR) / "docs/rendering.md");
    const std::string fence = "```json\n";
    const std::size_t begin = page.find(fence) + fence.size();
    ASSERT_NE(page.find(fence), std::string::npos);
    const TemporaryFolder folder;
    writeText(folder / "scene.json", reduced(page.substr(begin, page.find("```", begin) - begin)));
    const auto run = [&](std::vector<std::string> arguments) {
        const RunResult result = runBandvox(std::move(arguments), {.folder = folder.path()});
        EXPECT_EQ(result.status, 0) << result.err;
    };
    run({"convert", "shape:cube", "-o", "bunny.vdb", "-r", "16"});
    run({"convert", "shape:sphere", "-o", "ball.vdb", "-r", "16"});
    run({"render", "ball.vdb", "-o", "sky.exr", "--res", "16x8", "--background", "1,1,1"});
    run({"render", "scene.json", "-o", "scene.png"});
    EXPECT_TRUE(fs::exists(folder / "scene.png"));
}

}  // namespace
}  // namespace bandvox::app_test
