// convert -o asset.usda writes a volume, and a file of USD that refers to it.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>

namespace bandvox::app_test {
namespace {

using FileNames = std::vector<std::string>;

RunResult convertHere(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "convert");
    return runBandvox(arguments, {.folder = folder.path()});
}

TEST(ConvertUsd, WritesBothFiles) {
    const TemporaryFolder folder;
    writeText(folder / "painted.obj", coloredCubeObj());
    const RunResult result =
        convertHere(folder, {"painted.obj", "-o", "cube.usda", "-r", "24", "--color", "--half"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(folder.contents(), (FileNames{"cube.usda", "cube.vdb", "painted.obj"}));
    EXPECT_NE(result.err.find("cube.usda, which refers to cube.vdb"), std::string::npos)
        << result.err;
    const std::string text = readText(folder / "cube.usda");
    EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
    for (const auto& grid : readVdb(folder / "cube.vdb")) {
        const std::string name = grid->getName();
        EXPECT_NE(text.find("rel field:" + name + " = </Volume/" + name + ">"), std::string::npos)
            << text;
    }
    for (const char* line : {"asset filePath = @./cube.vdb@", "token fieldDataType = \"half\"",
                             "token vectorDataRoleHint = \"Color\"", "extent = [(-1."}) {
        EXPECT_NE(text.find(line), std::string::npos) << line << " in " << text;
    }
}

TEST(ConvertUsd, TakesVolumesToo) {
    const TemporaryFolder folder;
    ASSERT_EQ(convertHere(folder, {"shape:torus", "-o", "torus.vdb", "-r", "24"}).status, 0);
    const RunResult result =
        convertHere(folder, {"torus.vdb", "-o", "small.usda", "--factor", "2", "--lod", "1"});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string text = readText(folder / "small.usda");
    EXPECT_NE(text.find("token fieldName = \"density_level_1\""), std::string::npos) << text;
}

TEST(ConvertUsd, LeavesNothingOfWhatFails) {
    const TemporaryFolder folder;
    writeText(folder / "broken.obj", "v 1 2\n");
    EXPECT_EQ(convertHere(folder, {"broken.obj", "-o", "a.usda"}).status, 3);
    EXPECT_EQ(convertHere(folder, {"shape:torus", "-o", "none/a.usda", "-r", "16"}).status, 1);
    EXPECT_EQ(folder.contents(), (FileNames{"broken.obj"}));
}

TEST(ConvertUsd, IsOfOneVolume) {
    const TemporaryFolder folder;
    writeText(folder / "a.0001.obj", cubeObj());
    writeText(folder / "a.0002.obj", cubeObj());
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"a.####.obj", "-o", "a.####.usda"},
          std::vector<std::string>{"a.0001.obj", "-o", "a.usda", "--skip-existing"}}) {
        const RunResult result = convertHere(folder, arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_NE(result.err.find(".usda"), std::string::npos) << result.err;
    }
    EXPECT_EQ(folder.contents(), (FileNames{"a.0001.obj", "a.0002.obj"}));
}

}  // namespace
}  // namespace bandvox::app_test
