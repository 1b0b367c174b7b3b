// What the render command writes and reports.

#include "run_command.h"
#include "sample_files.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class Render : public testing::Test {
  protected:
    void SetUp() override {
        const RunResult result = runBandvox({"convert", "shape:sphere", "-o", "s.vdb", "-r", "32"},
                                            {.folder = mFolder.path()});
        ASSERT_EQ(result.status, 0) << result.err;
    }

    RunResult render(Names arguments) {
        arguments.insert(arguments.begin(), {"render", "s.vdb"});
        return runBandvox(arguments, {.folder = mFolder.path()});
    }

    /// All channels of a picture, [height][width][channels].
    std::vector<float> readPicture(const std::string& name, OIIO::ImageSpec& spec) {
        const auto input = OIIO::ImageInput::open((mFolder / name).string());
        if (!input) {
            ADD_FAILURE() << OIIO::geterror();
            return {};
        }
        spec = input->spec();
        std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
        EXPECT_TRUE(
            input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()));
        return pixels;
    }

    TemporaryFolder mFolder;
};

TEST_F(Render, WritesAPng) {
    const RunResult result = render({"-o", "s.png", "--res", "80x60"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(mFolder.contents(), (Names{"s.png", "s.vdb"}));
    OIIO::ImageSpec spec;
    const std::vector<float> pixels = readPicture("s.png", spec);
    EXPECT_EQ(spec.width, 80);
    EXPECT_EQ(spec.height, 60);
    ASSERT_EQ(spec.nchannels, 4);
    const auto alpha = [&](std::size_t x, std::size_t y) { return pixels[(y * 80 + x) * 4 + 3]; };
    EXPECT_EQ(alpha(40, 30), 1.0f);
    EXPECT_EQ(alpha(0, 0), 0.0f);
    EXPECT_GT(pixels[(30 * 80 + 40) * 4], 0.1f);
}

TEST_F(Render, WritesAnExrWithDepth) {
    ASSERT_EQ(
        render({"-o", "s.exr", "--res", "40x40", "--eye", "0,0,10", "--lookat", "0,0,0"}).status,
        0);
    OIIO::ImageSpec spec;
    const std::vector<float> pixels = readPicture("s.exr", spec);
    const int z = spec.channelindex("Z");
    ASSERT_GE(z, 0);
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    // The sphere has radius 1.
    EXPECT_NEAR(pixels[(20 * 40 + 20) * channels + static_cast<std::size_t>(z)], 9, 0.02);
}

TEST_F(Render, BackgroundFillsThePicture) {
    ASSERT_EQ(render({"-o", "s.png", "--res", "16x16", "--background", "0,1,0"}).status, 0);
    OIIO::ImageSpec spec;
    const std::vector<float> pixels = readPicture("s.png", spec);
    EXPECT_EQ(pixels[0], 0.0f);
    EXPECT_EQ(pixels[1], 1.0f);
    EXPECT_EQ(pixels[3], 1.0f);
}

TEST_F(Render, TakesEveryCameraOption) {
    for (const Names& lens : {Names{"--camera", "orthographic", "--frame", "3"},
                              Names{"--focal", "35", "--aperture", "36"}}) {
        Names all{"-o",      "s.png",   "--res",   "16x16",   "--samples", "2",
                  "--up",    "0,0,1",   "--from",  "-1,-1,1", "--iso",     "0.4",
                  "--light", "1,1,1",   "--color", "1,0.5,0", "--ambient", "0.3",
                  "--grid",  "density", "--stats", "r.json"};
        all.insert(all.end(), lens.begin(), lens.end());
        const RunResult result = render(all);
        ASSERT_EQ(result.status, 0) << result.err;
        const auto statistics = nlohmann::json::parse(readText(mFolder / "r.json"));
        EXPECT_EQ(statistics.at("counts").at("rays"), 16 * 16 * 2);
        EXPECT_GT(statistics.at("counts").at("hits").get<int>(), 0);
    }
}

TEST_F(Render, RefusesCameraOptionsThatChangeNothing) {
    for (const Names& arguments :
         {Names{"--fov", "40", "--camera", "orthographic"},
          Names{"--focal", "40", "--camera", "orthographic"}, Names{"--frame", "3"},
          Names{"--from", "0,0,1", "--eye", "0,0,9"}, Names{"--fov", "40", "--focal", "40"},
          Names{"--aperture", "1e-300"}, Names{"--extinction", "0", "--mode", "volume"}}) {
        Names all{"-o", "s.png", "--res", "8x8"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const RunResult result = render(all);
        EXPECT_EQ(result.status, 2) << arguments[0] << result.err;
        EXPECT_NE(result.err.find(arguments[0]), std::string::npos) << result.err;
    }
}

TEST_F(Render, WhatIsAskedForComesBeforeWhatAFileSays) {
    const auto picture = [&](const Names& arguments) {
        Names all{"-o", "s.png", "--res", "16x16"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const RunResult result = render(all);
        EXPECT_EQ(result.status, 0) << result.err;
        OIIO::ImageSpec spec;
        return readPicture("s.png", spec);
    };
    const Names eye{"--eye", "0,0,9", "--lookat", "0,0,0"};
    writeText(mFolder / "lens.cfg", "fov = 20\neye = 0,0,9\nlookat = 0,0,0\n");
    EXPECT_EQ(picture({"--config", "lens.cfg", "--focal", "80"}),
              picture({eye[0], eye[1], eye[2], eye[3], "--focal", "80"}));
    writeText(mFolder / "lens.cfg", "focal = 20\neye = 0,0,9\nlookat = 0,0,0\n");
    EXPECT_EQ(picture({"--config", "lens.cfg", "--fov", "30"}),
              picture({eye[0], eye[1], eye[2], eye[3], "--fov", "30"}));
    writeText(mFolder / "flat.cfg", "camera = orthographic\nframe = 3\n");
    EXPECT_EQ(picture({"--config", "flat.cfg", "--camera", "perspective"}), picture({}));
    writeText(mFolder / "light.cfg", "light = 1,0,0\n");
    EXPECT_EQ(picture({"--config", "light.cfg", "--light-at", "0,9,0"}),
              picture({"--light-at", "0,9,0"}));
}

TEST_F(Render, NothingSeenIsAFailure) {
    const RunResult result =
        render({"-o", "s.png", "--res", "16x16", "--eye", "0,0,10", "--lookat", "0,0,20"});
    EXPECT_EQ(result.status, 4) << result.err;
    EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
    EXPECT_EQ(mFolder.contents(), Names{"s.vdb"});
}

TEST_F(Render, ReadsTheStandardInput) {
    const RunResult result =
        runBandvox({"render", "stdin.vdb", "-o", "s.png", "--res", "16x16"},
                   {.folder = mFolder.path(), .standardInput = (mFolder / "s.vdb").string()});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(mFolder.contents(), (Names{"s.png", "s.vdb"}));
}

TEST_F(Render, SeesFromFarAwayAndFromAbove) {
    for (const Names& arguments :
         {Names{"--eye", "0,1,1e11"}, Names{"--from", "0,1,0"}, Names{"--from", "0,-1,0"}}) {
        Names all{"-o", "s.png", "--res", "4x4", "--camera", "orthographic"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const RunResult result = render(all);
        EXPECT_EQ(result.status, 0) << arguments[1] << result.err;
    }
}

TEST_F(Render, JudgesTheViewBeforeItReads) {
    for (const Names& arguments :
         {Names{"--up", "0,0,0"}, Names{"--light", "0,0,0"}, Names{"--eye", "1e200,0,0"},
          Names{"--up", "0,2,0", "--from", "0,1,0"},
          Names{"--eye", "1,1,1", "--lookat", "1,1,1"}}) {
        Names all{"render", "none.vdb", "-o", "s.png"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const RunResult result = runBandvox(all, {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 2) << arguments[0] << result.err;
        EXPECT_NE(result.err.find(arguments[0].substr(2)), std::string::npos) << result.err;
    }
}

TEST_F(Render, ViewThatIsNoneIsWrongUsage) {
    for (const Names& arguments :
         {Names{"--eye", "1,1,1", "--lookat", "1,1,1"}, Names{"--eye", "0,0,0"},
          Names{"--up", "0,0,0"}, Names{"--from", "0,0,0"}}) {
        Names all{"-o", "s.png", "--res", "8x8"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const RunResult result = render(all);
        EXPECT_EQ(result.status, 2) << arguments[0] << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
        EXPECT_EQ(mFolder.contents(), Names{"s.vdb"});
    }
}

}  // namespace
}  // namespace bandvox::app_test
