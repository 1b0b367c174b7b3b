// What the render command says of inputs, scene files and values that it cannot draw by.

#include "build_places.h"
#include "run_command.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

/// A cube of 3³ voxels of a value.
openvdb::FloatGrid::Ptr blockOf(float value, const std::string& name = "density") {
    auto grid = openvdb::FloatGrid::create(0);
    grid->setName(name);
    grid->fill(openvdb::CoordBBox(openvdb::Coord(-1), openvdb::Coord(1)), value);
    return grid;
}

class RenderRefusals : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        openvdb::initialize();
        sFolder = std::make_unique<TemporaryFolder>();
        writeVdb(*sFolder / "good.vdb", {blockOf(1)});
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult render(Names arguments) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), {"--res", "8x8"});
        return runBandvox(arguments, {.folder = sFolder->path()});
    }

    /// Expects that a picture is refused in words that have each of `parts`.
    static void expectRefused(const Names& arguments, int status, const Names& parts) {
        const RunResult result = render(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        for (const std::string& part : parts) {
            EXPECT_NE(result.err.find(part), std::string::npos) << part << ": " << result.err;
        }
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> RenderRefusals::sFolder;

TEST_F(RenderRefusals, AnErrorNamesTheFileOfItsGrid) {
    const auto distances =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1, openvdb::Vec3f(0), 0.2F);
    auto colors = openvdb::Vec3SGrid::create();
    colors->setName("Cd");
    colors->tree().setValue(openvdb::Coord(0), openvdb::Vec3f(kNoNumber));
    writeVdb(*sFolder / "nan.vdb", {blockOf(kNoNumber)});
    writeVdb(*sFolder / "empty.vdb", {blockOf(0)->copyWithNewTree()});
    writeVdb(*sFolder / "distances.vdb", {distances});
    writeVdb(*sFolder / "colours.vdb", {blockOf(1), colors});
    writeVdb(*sFolder / "heat.vdb", {blockOf(1), blockOf(kNoNumber, "temperature")});
    writeVdb(*sFolder / "thin.vdb", {blockOf(0.25F)});
    struct Case {
        std::string file;
        Names options;
        int status;
    };
    const std::vector<Case> cases{{"nan.vdb", {}, 3},
                                  {"nan.vdb", {"--mode", "volume"}, 3},
                                  {"empty.vdb", {}, 3},
                                  {"distances.vdb", {"--mode", "volume"}, 3},
                                  {"colours.vdb", {}, 3},
                                  {"heat.vdb", {"--mode", "volume"}, 3},
                                  {"thin.vdb", {"--iso", "0.5/-1"}, 2},
                                  {"thin.vdb", {"--scale", "1/1e-9"}, 2}};
    for (const auto& [file, options, status] : cases) {
        SCOPED_TRACE(file);
        Names arguments{"good.vdb", file, "-o", "x.png"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expectRefused(arguments, status, {"'" + file + "': "});
    }
    expectRefused({"thin.vdb", "nan.vdb", "-o", "x.png", "--mode", "volume/surface"}, 3,
                  {"'nan.vdb': "});
    expectRefused({"thin.vdb", "-o", "x.png"}, 4, {"'thin.vdb': the density is at most 0.25"});
    expectRefused(
        {"thin.vdb", "thin.vdb", "-o", "x.png", "--iso", "0.5/0.75"}, 4,
        {"'thin.vdb': the density is at most 0.25, below the iso-value 0.5; 'thin.vdb': ", "0.75"});
    expectRefused({"empty.vdb", "-o", "x.png", "--shading", "depth"}, 3, {"'empty.vdb': "});
    expectRefused({"thin.vdb", "-o", "x.png", "--shading", "depth"}, 4, {"'thin.vdb': "});
}

TEST_F(RenderRefusals, AnErrorNamesTheFrameAndItsFile) {
    writeVdb(*sFolder / "in.0007.vdb", {blockOf(1)});
    writeVdb(*sFolder / "in.0008.vdb", {blockOf(kNoNumber)});
    writeVdb(*sFolder / "in.0009.vdb", {blockOf(1, "heat"), blockOf(1, "smoke")});
    writeVdb(*sFolder / "in.0010.vdb", {blockOf(0.25F)});
    for (const auto& [frame, status, file] :
         {std::tuple{"8", 3, "'in.0008.vdb'"}, std::tuple{"9", 3, "'in.0009.vdb'"},
          std::tuple{"10", 4, "'in.0010.vdb'"}, std::tuple{"11", 3, "in.0011.vdb"}}) {
        const Names words{"frame " + std::string(frame) + ": ", file};
        expectRefused({"in.####.vdb", "-o", "out.####.png", "--frames", frame}, status, words);
        expectRefused({"in.####.vdb", "good.vdb", "-o", "out.####.png", "--frames", frame, "--mode",
                       "surface", "--iso", "0.5/2"},
                      status, words);
    }
    expectRefused({"in.####.vdb", "-o", "out.####.png", "--frames", "7-10x3", "--shading", "depth"},
                  4, {"frame 10: ", "'in.0010.vdb': "});
}

TEST_F(RenderRefusals, AnErrorNamesTheObjectOfASceneFile) {
    writeVdb(*sFolder / "nan.vdb", {blockOf(kNoNumber)});
    writeText(*sFolder / "scene.json",
              R"({"objects": [{"file": "good.vdb"}, {"file": "nan.vdb"}]})");
    expectRefused({"scene.json", "-o", "x.png"}, 3, {"'scene.json': objects[1] ('nan.vdb'): "});
    // What the file asks for is no wrong use of the command.
    for (const char* setting : {R"("iso": -1)", R"("scale": 1e-9)"}) {
        writeText(*sFolder / "scene.json", R"({"objects": [{"file": "good.vdb"}, {"file": )"
                                           R"("good.vdb", )" +
                                               std::string(setting) + "}]}");
        expectRefused({"scene.json", "-o", "x.png"}, 3, {"'scene.json': objects[1] ("});
    }
}

TEST_F(RenderRefusals, SettingsOfASceneFileThatDoNotGoTogetherAreNamed) {
    const auto write = [](const std::string& groups) {
        writeText(*sFolder / "view.json", R"({"objects": [{"file": "good.vdb"}], )" + groups + "}");
    };
    write(R"("camera": {"eye": [1, 2, 3], "lookat": [1, 2, 3]})");
    expectRefused({"view.json", "-o", "x.png"}, 3,
                  {"'view.json': camera.eye, camera.lookat: ", "expected two places"});
    // An option takes part in it, or undoes it.
    expectRefused({"view.json", "-o", "x.png", "--lookat", "1,2,3"}, 2,
                  {"'view.json': camera.eye"});
    EXPECT_EQ(render({"view.json", "-o", "x.png", "--eye", "0,0,9", "--lookat", "0,0,0"}).status,
              0);
    write(R"("camera": {"eye": [0, 0, 0]})");  // which is the middle
    expectRefused({"view.json", "-o", "x.png"}, 3, {"'view.json': camera.eye: "});
    write(R"("camera": {"from": [0, 0, 0]})");
    expectRefused({"view.json", "-o", "x.png"}, 3, {"'view.json': camera.from: "});
    write(R"("camera": {"up": [0, 0, 2], "from": [0, 0, 1]})");
    expectRefused({"view.json", "-o", "x.png"}, 3, {"'view.json': camera.from, camera.up: "});
    write(R"("picture": {"crop": [0, 0, 50, 50]})");
    expectRefused({"view.json", "-o", "x.png"}, 2, {"'view.json': picture.crop, --res: ", "8 x 8"});
    write(R"("picture": {"gather": 0, "bounces": 2})");
    expectRefused({"view.json", "-o", "x.png"}, 3, {"'view.json': picture.bounces: "});
    write(R"("picture": {"channels": "depth"})");
    expectRefused({"view.json", "-o", "x.png"}, 2, {"'view.json': picture.channels: "});
    write(R"("camera": {"eye": [0, 0, 5]})");
    expectRefused({"view.json", "-o", "x.png", "--up", "0,0,1"}, 2,
                  {"'view.json': camera.eye, --up: "});
    write(R"("camera": {"eye": [0, 0, 5], "up": [0, 0, 1]})");
    for (const char* shading : {"spectral", "phong"}) {
        expectRefused({"view.json", "-o", "x.png", "--shading", shading}, 3,
                      {"'view.json': camera.eye, camera.up: the camera's up"});
    }
    // What options alone ask for is theirs.
    write(R"("picture": {"samples": 1})");
    const RunResult result =
        render({"view.json", "-o", "x.png", "--eye", "1,2,3", "--lookat", "1,2,3"});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.err.find("view.json"), std::string::npos) << result.err;
}

TEST_F(RenderRefusals, AnyGridCanBeChosen) {
    const Names names{"a/b", "a", "a", "a[1]", "x[0]", "x", "c\\d", "e\\/f", "", "none"};
    openvdb::GridCPtrVec grids;
    for (std::size_t i = 0; i < names.size(); ++i) {
        grids.push_back(blockOf(1 + static_cast<float>(i), names[i]));
    }
    writeVdb(*sFolder / "names.vdb", grids);
    // Seen where it is as high as the only one of its height.
    const auto expectChosen = [](const Names& arguments, std::size_t i) {
        const RunResult low = render(arguments);
        EXPECT_EQ(low.status, 4) << low.err;
        const std::string height = "at most " + std::to_string(i + 1) + ",";
        EXPECT_NE(low.err.find(height), std::string::npos) << height << low.err;
    };
    const std::vector<std::pair<std::string, std::size_t>> chosen{
        {"a/b", 0}, {"a[0]", 1}, {"a[1]", 2},  {"a[1][0]", 3}, {"x[0]", 4}, {"x[0][0]", 4},
        {"x", 5},   {"c\\d", 6}, {"e\\/f", 7}, {"[0]", 8},     {"none", 9}};
    for (const auto& [name, i] : chosen) {
        SCOPED_TRACE(name);
        expectChosen({"names.vdb", "-o", "x.png", "--iso", "100", "--grid", name}, i);
    }
    const std::vector<std::pair<std::string, std::size_t>> ofTwo{
        {"a\\/b/x", 0}, {"e\\\\\\/f/a\\/b", 7}, {"c\\d/x", 6}, {"c\\\\d/x", 6}, {"a\\/b", 0}};
    for (const auto& [text, i] : ofTwo) {
        SCOPED_TRACE(text);
        expectChosen({"names.vdb", "names.vdb", "-o", "x.png", "--iso", "100", "--grid", text}, i);
    }
    expectRefused({"names.vdb", "names.vdb", "-o", "x.png", "--grid", "a/b/x"}, 2,
                  {"2 inputs", "a backslash before a slash"});
    // JSON has lists for several objects, and takes a name as it is.
    writeText(*sFolder / "names.json",
              R"({"objects": [{"file": "names.vdb", "iso": 100, "grid": "a/b"}]})");
    expectChosen({"names.json", "-o", "x.png"}, 0);
}

TEST_F(RenderRefusals, IsoValuesThatNothingReachesAreToldAtOnce) {
    ASSERT_EQ(runBandvox({"convert", "shape:sphere", "-o", "ball.vdb", "-r", "64"},
                         {.folder = sFolder->path()})
                  .status,
              0);
    writeVdb(*sFolder / "distances.vdb", {openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                                             1, openvdb::Vec3f(0), 0.05F)});
    const auto start = std::chrono::steady_clock::now();
    for (const char* file : {"ball.vdb", "good.vdb"}) {
        expectRefused({file, "-o", "x.png", "--iso", "1e-100"}, 2, {"above the grid's background"});
        expectRefused({file, "-o", "x.png", "--iso", "1e300"}, 4, {"is at most 1", "1e+300"});
        expectRefused({file, "-o", "x.png", "--iso=-1e300"}, 2, {"above the grid's background"});
        expectRefused({file, "-o", "x.png", "--iso", "1e-100", "--shading", "depth"}, 2,
                      {"above the grid's background"});
        EXPECT_EQ(render({file, "-o", "x.png", "--iso", "1e-40"}).status, 0);
    }
    expectRefused({"distances.vdb", "-o", "x.png", "--iso", "1e300"}, 2,
                  {"below the level set's background"});
    expectRefused({"distances.vdb", "-o", "x.png", "--iso=-1e300"}, 4,
                  {"the level set is at least -0.15", "-1e+300"});
    EXPECT_EQ(render({"distances.vdb", "-o", "x.png", "--iso", "1e-100"}).status, 0);
    // Minutes when blocks of background were looked at.
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 60);
}

TEST_F(RenderRefusals, AColourConfigurationThatIsNotUsedIsTold) {
    const std::string head =
        "ocio_profile_version: 1\nstrictparsing: true\nroles:\n"
        "  default: raw\n  scene_linear: raw\ndisplays:\n  default:\n"
        "    - !<View> {name: Raw, colorspace: raw}\ncolorspaces:\n"
        "  - !<ColorSpace>\n    name: raw\n    bitdepth: 32f\n";
    writeText(*sFolder / "broken.ocio", "no configuration");
    const std::string other = "  - !<ColorSpace>\n    name: ";
    const std::string root =
        "\n    bitdepth: 32f\n    from_reference: !<ExponentTransform> "
        "{value: [0.5, 0.5, 0.5, 1]}\n";
    writeText(*sFolder / "raw.ocio", head);
    writeText(*sFolder / "other.ocio", head + other + "root" + root);
    writeText(*sFolder / "whole.ocio", head + other + "sRGB" + root);
    const auto renderBy = [](const std::string& configuration, const Names& more) {
        Names arguments{"/usr/bin/env",
                        "OCIO=" + configuration,
                        build_places::command(),
                        "render",
                        "good.vdb",
                        "--res",
                        "8x8"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments, {.folder = sFolder->path()});
    };
    ASSERT_EQ(renderBy("", {"-o", "plain.png"}).status, 0);
    for (const auto& [file, why] :
         {std::pair{"none.ocio", "non-existent"}, std::pair{"broken.ocio", "Error reading"},
          std::pair{"other.ocio", "'sRGB'"}, std::pair{"raw.ocio", "raw data alone"}}) {
        const RunResult result = renderBy(file, {"-o", "fallback.png"});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: warning: '" + std::string(file) + "'"), 1)
            << result.err;
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
        EXPECT_EQ(renderBy(file, {"-o", "x.png", "--strict"}).status, 1);
        // Linear light needs none.
        EXPECT_EQ(countLines(renderBy(file, {"-o", "x.exr"}).err, "bandvox: warning"), 0);
    }
    const RunResult whole = renderBy("whole.ocio", {"-o", "whole.png"});
    EXPECT_EQ(whole.status, 0) << whole.err;
    EXPECT_EQ(countLines(whole.err, "bandvox: warning"), 0) << whole.err;
    EXPECT_EQ(countLines(renderBy("", {"-o", "x.png"}).err, "bandvox: warning"), 0);
}

}  // namespace
}  // namespace bandvox::app_test
