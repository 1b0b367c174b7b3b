// Scenes, sequences and views of the render command.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

struct Picture {
    OIIO::ImageSpec spec;
    std::vector<float> pixels;

    std::vector<float> at(int column, int row) const {
        const std::size_t first =
            (static_cast<std::size_t>(row) * spec.width + column) * spec.nchannels;
        return {pixels.begin() + static_cast<std::ptrdiff_t>(first),
                pixels.begin() + static_cast<std::ptrdiff_t>(first) + spec.nchannels};
    }
};

class RenderScene : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        for (const char* shape : {"sphere", "cube"}) {
            const RunResult result = runBandvox({"convert", std::string("shape:") + shape, "-o",
                                                 std::string(shape) + ".vdb", "-r", "24"},
                                                {.folder = sFolder->path()});
            ASSERT_EQ(result.status, 0) << result.err;
        }
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult render(Names arguments) {
        arguments.insert(arguments.begin(), "render");
        return runBandvox(arguments, {.folder = sFolder->path()});
    }

    static Picture read(const std::string& name) {
        Picture picture;
        const auto input = OIIO::ImageInput::open((*sFolder / name).string());
        if (!input) {
            ADD_FAILURE() << OIIO::geterror();
            return picture;
        }
        picture.spec = input->spec();
        picture.pixels.resize(picture.spec.image_pixels() *
                              static_cast<std::size_t>(picture.spec.nchannels));
        EXPECT_TRUE(input->read_image(0, 0, 0, picture.spec.nchannels, OIIO::TypeDesc::FLOAT,
                                      picture.pixels.data()));
        return picture;
    }

    static bool isThere(const std::string& name) {
        return std::filesystem::exists(*sFolder / name);
    }

    static void writeGrids(const std::string& name, const openvdb::GridCPtrVec& grids) {
        writeVdb(*sFolder / name, grids);
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> RenderScene::sFolder;

const Names kParallel{"--camera", "orthographic", "--res", "32x32"};
const Names kFront{"--camera", "orthographic", "--from", "0,0,1", "--res", "32x32"};

Names with(const Names& first, const Names& second) {
    Names all = first;
    all.insert(all.end(), second.begin(), second.end());
    return all;
}

TEST_F(RenderScene, ASceneFileIsWhatItsOptionsAre) {
    writeText(*sFolder / "scene.json", R"({
        "objects": [{"file": "sphere.vdb", "color": [1, 0.5, 0.25], "reflectance": 0.04},
                    {"file": "cube.vdb", "transparency": 0.5, "refraction": 1.2}],
        "lights": [{"direction": [0, 1, 1], "space": "camera", "color": [0.9, 0.9, 0.9]}],
        "environment": {"color": [0.1, 0.1, 0.1]},
        "camera": {"from": [1, 1, 1], "fov": 30},
        "picture": {"res": [40, 30], "samples": 4, "shadows": true, "background": [0, 0, 1]}})");
    const RunResult file = render({"scene.json", "-o", "file.exr"});
    ASSERT_EQ(file.status, 0) << file.err;
    const RunResult options = render({"sphere.vdb",
                                      "cube.vdb",
                                      "-o",
                                      "options.exr",
                                      "--color",
                                      "1,0.5,0.25/0.8,0.8,0.8",
                                      "--reflectance",
                                      "0.04/0",
                                      "--transparency",
                                      "0/0.5",
                                      "--refraction",
                                      "1.5/1.2",
                                      "--light",
                                      "0,1,1",
                                      "--from",
                                      "1,1,1",
                                      "--fov",
                                      "30",
                                      "--res",
                                      "40x30",
                                      "--samples",
                                      "4",
                                      "--shadows",
                                      "--background",
                                      "0,0,1"});
    ASSERT_EQ(options.status, 0) << options.err;
    EXPECT_EQ(read("file.exr").pixels, read("options.exr").pixels);

    // What the command line says comes after what the file says.
    ASSERT_EQ(render({"scene.json", "-o", "small.exr", "--res", "8x6"}).status, 0);
    EXPECT_EQ(read("small.exr").spec.width, 8);
}

TEST_F(RenderScene, RefusesSceneFilesThatAreNone) {
    const std::vector<std::pair<std::string, std::string>> files{
        {"", "JSON"},
        {"[]", "objects"},
        {"{}", "objects"},
        {R"({"objects": []})", "objects"},
        {R"({"object": []})", "object"},
        {R"({"objects": [{}]})", "file"},
        {R"({"objects": [{"file": "sphere.vdb", "iso": 0.4, "iso": 0.5}]})", "'iso' twice"},
        {R"({"objects": [{"file": "sphere.vdb", "colour": [1, 1, 1]}]})", "did you mean 'color'"},
        {R"({"objects": [{"file": "sphere.vdb", "color": [1, 1]}]})", "three numbers"},
        {R"({"objects": [{"file": "sphere.vdb", "roughness": 2}]})", "roughness"},
        {R"({"objects": [{"file": "sphere.vdb", "iso": {}}]})", "iso"},
        {R"({"objects": [{"file": "none.vdb"}]})", "none.vdb"},
        {R"({"objects": [{"file": "sphere.vdb"}], "lights": [{}]})", "direction"},
        {R"({"objects": [{"file": "sphere.vdb"}], "lights": {}})", "lights"},
        {R"({"objects": [{"file": "sphere.vdb"}], "picture": {"res": "big"}})", "res"},
        {R"({"objects": [{"file": "sphere.vdb"}], "environment": {"file": "none.exr"}})",
         "none.exr"}};
    for (const auto& [text, named] : files) {
        writeText(*sFolder / "bad.json", text);
        const RunResult result = render({"bad.json", "-o", "bad.png"});
        EXPECT_TRUE(result.status == 3 || result.status == 2) << text << result.err;
        EXPECT_NE(result.err.find(named), std::string::npos) << text << result.err;
        EXPECT_FALSE(isThere("bad.png")) << text;
    }
    writeText(*sFolder / "good.json", R"({"objects": [{"file": "sphere.vdb"}]})");
    EXPECT_EQ(render({"good.json", "sphere.vdb", "-o", "bad.png"}).status, 2);
    EXPECT_EQ(
        render({"cube.vdb", "-o", "f.###.png", "--turntable", "3", "--stats", "f.002.png"}).status,
        2);
    EXPECT_EQ(render({"good.json", "-o", "bad.png", "--color", "1,1,1"}).status, 2);
}

TEST_F(RenderScene, OneValueForAllInputsOrOneForEach) {
    const RunResult result =
        render({"sphere.vdb", "cube.vdb", "-o", "x.png", "--roughness", "0.1/0.2/0.3"});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("2 inputs"), std::string::npos) << result.err;
}

TEST_F(RenderScene, DrawsVolumes) {
    const RunResult result =
        render(with({"sphere.vdb", "-o", "fog.exr", "--mode", "volume", "--extinction", "1",
                     "--color", "0,0,0", "--ambient", "0"},
                    kFront));
    ASSERT_EQ(result.status, 0) << result.err;
    const Picture picture = read("fog.exr");
    // Of e^-1 for each world unit the ball, 2 across but for what the filter rounds off, leaves
    // this.
    EXPECT_NEAR(picture.at(16, 16)[3], 1 - std::exp(-2), 0.01);
    EXPECT_EQ(picture.at(16, 16)[0], 0);
    EXPECT_EQ(picture.at(0, 0)[3], 0);
}

TEST_F(RenderScene, ColorsComeFromTheirGrid) {
    const auto grids = readVdb(*sFolder / "sphere.vdb");
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(grids.at(0));
    auto colors = openvdb::Vec3SGrid::create();
    colors->setName("Cd");
    colors->setTransform(density->transformPtr());
    for (auto voxel = density->cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Coord at = voxel.getCoord();
        colors->tree().setValue(at, at.x() < 0 ? openvdb::Vec3f(1, 0, 0) : openvdb::Vec3f(0, 1, 0));
    }
    writeGrids("coloured.vdb", {density, colors});
    ASSERT_EQ(render(with({"coloured.vdb", "-o", "coloured.exr"}, kFront)).status, 0);
    const Picture picture = read("coloured.exr");
    EXPECT_GT(picture.at(8, 16)[0], 0.1);
    EXPECT_EQ(picture.at(8, 16)[1], 0);
    EXPECT_EQ(picture.at(24, 16)[0], 0);
    EXPECT_GT(picture.at(24, 16)[1], 0.1);
    ASSERT_EQ(render(with({"coloured.vdb", "-o", "plain.exr", "--colors", "none"}, kFront)).status,
              0);
    EXPECT_EQ(read("plain.exr").at(8, 16)[0], read("plain.exr").at(8, 16)[1]);
    const RunResult none =
        render(with({"coloured.vdb", "-o", "x.exr", "--colors", "tint"}, kFront));
    EXPECT_EQ(none.status, 3);
    EXPECT_NE(none.err.find("'Cd' (vec3s)"), std::string::npos) << none.err;
}

TEST_F(RenderScene, GridsOfOneNameAreToldApart) {
    openvdb::initialize();
    const auto make = [](float radius) {
        auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
            radius, openvdb::Vec3f(0), 0.1F);
        grid->setName("surface");
        return grid;
    };
    writeGrids("twins.vdb", {make(1), make(0.5F)});
    const RunResult both = render(with({"twins.vdb", "-o", "x.png", "--grid", "surface"}, kFront));
    EXPECT_EQ(both.status, 3);
    EXPECT_NE(both.err.find("surface[1]"), std::string::npos) << both.err;
    EXPECT_EQ(render(with({"twins.vdb", "-o", "x.png"}, kFront)).status, 3);
    const Names view = with(kParallel, {"--frame", "4", "--eye", "0,0,5", "--lookat", "0,0,0"});
    ASSERT_EQ(render(with({"twins.vdb", "-o", "0.exr", "--grid", "surface[0]"}, view)).status, 0);
    ASSERT_EQ(render(with({"twins.vdb", "-o", "1.exr", "--grid", "surface[1]"}, view)).status, 0);
    EXPECT_NEAR(read("0.exr").at(16, 16)[4], 4, 0.02);
    EXPECT_NEAR(read("1.exr").at(16, 16)[4], 4.5, 0.02);

    auto doubles = std::make_shared<openvdb::DoubleGrid>(*make(1));
    doubles->setGridClass(openvdb::GRID_LEVEL_SET);
    writeGrids("doubles.vdb", {doubles});
    EXPECT_EQ(render(with({"doubles.vdb", "-o", "x.png"}, kFront)).status, 0);
}

TEST_F(RenderScene, ObjectsAreMoved) {
    const Names view = with(kParallel, {"--frame", "8", "--eye", "0,0,9", "--lookat", "0,0,0"});
    ASSERT_EQ(render(with({"sphere.vdb", "cube.vdb", "-o", "moved.exr", "--scale", "0.5/1",
                           "--translate", "-2,0,1/2,1,0", "--rotate", "0,0,0/0,0,45"},
                          view))
                  .status,
              0);
    const Picture picture = read("moved.exr");
    // Four pixels to a unit. The ball's top is half a unit above (-2, 0, 1).
    EXPECT_NEAR(picture.at(8, 16)[4], 7.5, 0.05);
    EXPECT_TRUE(std::isinf(picture.at(8, 12)[4]));
    // The cube stands on an edge: wider in its middle than it is long.
    EXPECT_NEAR(picture.at(24, 12)[4], 8, 0.05);
    EXPECT_FALSE(std::isinf(picture.at(19, 11)[4]));
    EXPECT_TRUE(std::isinf(picture.at(20, 8)[4]));
}

TEST_F(RenderScene, ACropIsAPartOfThePicture) {
    ASSERT_EQ(render({"cube.vdb", "-o", "all.exr", "--res", "40x30", "--samples", "3"}).status, 0);
    ASSERT_EQ(render({"cube.vdb", "-o", "part.exr", "--res", "40x30", "--samples", "3", "--crop",
                      "10,5,30,25"})
                  .status,
              0);
    const Picture all = read("all.exr"), part = read("part.exr");
    EXPECT_EQ(part.spec.width, 20);
    EXPECT_EQ(part.spec.x, 10);
    EXPECT_EQ(part.spec.y, 5);
    EXPECT_EQ(part.spec.full_width, 40);
    for (int row = 0; row < 20; ++row) {
        for (int column = 0; column < 20; ++column) {
            EXPECT_EQ(part.at(column, row), all.at(column + 10, row + 5));
        }
    }
    for (const char* crop : {"0,0,41,30", "5,5,5,10", "-1,0,3,3", "1,2,3", "a,b,c,d"}) {
        EXPECT_EQ(render({"cube.vdb", "-o", "x.png", "--res", "40x30", "--crop", crop}).status, 2)
            << crop;
    }
}

TEST_F(RenderScene, ChannelsAreChosen) {
    ASSERT_EQ(
        render({"cube.vdb", "-o", "some.exr", "--res", "9x7", "--channels", "depth,normal"}).status,
        0);
    EXPECT_EQ(read("some.exr").spec.channelnames,
              (std::vector<std::string>{"Z", "N.X", "N.Y", "N.Z"}));
    for (const char* channels : {"z", "depth,", "color depth"}) {
        const RunResult result = render({"cube.vdb", "-o", "x.exr", "--channels", channels});
        EXPECT_EQ(result.status, 2) << channels;
        EXPECT_NE(result.err.find("color,depth,normal,position"), std::string::npos) << result.err;
    }
    EXPECT_EQ(render({"cube.vdb", "-o", "x.png", "--channels", "color"}).status, 2);
}

TEST_F(RenderScene, ATurntableGoesOnceAround) {
    const RunResult result = render({"cube.vdb", "-o", "turn.%03d.exr", "--turntable", "4", "--res",
                                     "24x24", "--from", "0,1,2", "--stats", "turn.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    // Seen from its sides a cube always looks the same, but for rounding.
    const Picture first = read("turn.001.exr");
    for (const char* name : {"turn.002.exr", "turn.003.exr", "turn.004.exr"}) {
        const Picture other = read(name);
        for (std::size_t i = 4; i < first.pixels.size(); i += 11) {
            if (std::isinf(first.pixels[i])) {
                EXPECT_TRUE(std::isinf(other.pixels[i]));
            } else {
                EXPECT_NEAR(other.pixels[i], first.pixels[i], 1e-4);
            }
        }
    }
    const auto statistics = nlohmann::json::parse(readText(*sFolder / "turn.json"));
    EXPECT_EQ(statistics["counts"]["frames"], 4);

    ASSERT_EQ(render({"cube.vdb", "-o", "some.#.png", "--turntable", "8", "--frames", "2-8x3",
                      "--res", "8x8"})
                  .status,
              0);
    EXPECT_FALSE(isThere("some.1.png"));
    for (const char* name : {"some.2.png", "some.5.png", "some.8.png"}) EXPECT_TRUE(isThere(name));
    EXPECT_EQ(render({"cube.vdb", "-o", "x.png", "--turntable", "4"}).status, 2);
    EXPECT_EQ(render({"cube.vdb", "-o", "x.#.png", "--turntable", "4", "--frames", "5"}).status, 2);
    EXPECT_EQ(render({"cube.vdb", "-o", "x.#.png", "--frames", "3-1"}).status, 2);
}

TEST_F(RenderScene, FramesOfASequence) {
    std::filesystem::copy_file(*sFolder / "cube.vdb", *sFolder / "in.0007.vdb");
    std::filesystem::copy_file(*sFolder / "sphere.vdb", *sFolder / "in.0008.vdb");
    const RunResult result =
        render({"in.####.vdb", "-o", "out.####.png", "--frames", "7-8", "--res", "8x8"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(isThere("out.0007.png") && isThere("out.0008.png"));
    EXPECT_EQ(render({"in.####.vdb", "-o", "out.png"}).status, 2);
    EXPECT_EQ(
        render({"in.####.vdb", "-o", "gone.####.png", "--frames", "8-9", "--res", "8x8"}).status,
        3);
    EXPECT_TRUE(isThere("gone.0008.png")) << "frames before the one that is not there are kept";
}

TEST_F(RenderScene, APreviewEndsAsThePicture) {
    const Names all{"--res", "64x64", "--samples", "4"};
    ASSERT_EQ(render(with({"cube.vdb", "-o", "without.exr"}, all)).status, 0);
    const RunResult result = render(with({"cube.vdb", "-o", "with.exr", "--preview", "0"}, all));
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(read("with.exr").pixels, read("without.exr").pixels);
}

TEST_F(RenderScene, ACameraOfAGltfFile) {
    // At (0, 0, 6), turned a quarter about z, so that x is up.
    writeText(*sFolder / "view.gltf", R"({"asset": {"version": "2.0"},
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
                    {"type": "orthographic", "name": "flat",
                     "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 10}}],
        "nodes": [{"children": [1], "translation": [0, 0, 4]},
                  {"camera": 0, "translation": [0, 0, 2],
                   "rotation": [0, 0, 0.70710678, 0.70710678]},
                  {"camera": 1, "translation": [0, 0, 5]}]})");
    const RunResult gltf =
        render({"cube.vdb", "-o", "gltf.exr", "--camera-file", "view.gltf", "--res", "30x20"});
    ASSERT_EQ(gltf.status, 0) << gltf.err;
    const double focal = 0.5 * 41.2136 * (20.0 / 30) / std::tan(0.25);
    ASSERT_EQ(render({"cube.vdb", "-o", "words.exr", "--eye", "0,0,6", "--lookat", "0,0,0", "--up",
                      "-1,0,0", "--focal", std::to_string(focal), "--res", "30x20"})
                  .status,
              0);
    const Picture a = read("gltf.exr"), b = read("words.exr");
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t seen = 0;
    for (std::size_t i = 4; i < a.pixels.size(); i += 11) {
        if (std::isinf(a.pixels[i]) || std::isinf(b.pixels[i])) continue;
        EXPECT_NEAR(a.pixels[i], b.pixels[i], 1e-4);
        ++seen;
    }
    EXPECT_GT(seen, 30u);
    ASSERT_EQ(
        render({"cube.vdb", "-o", "flat.exr", "--camera-file", "view.gltf:flat", "--res", "20x20"})
            .status,
        0);
    EXPECT_NEAR(read("flat.exr").at(10, 10)[4], 4, 0.02);
    for (const char* file : {"none.gltf", "view.gltf:nobody", "cube.vdb"}) {
        const RunResult bad = render({"cube.vdb", "-o", "x.exr", "--camera-file", file});
        EXPECT_EQ(bad.status, 3) << file << bad.err;
    }
}

TEST_F(RenderScene, NodesOfAGltfFileThatShareTheirChildrenEnd) {
    std::string nodes;
    for (int i = 0; i < 60; ++i) {
        const std::string next = std::to_string(i + 1);
        nodes += R"({"children": [)" + next + "," + next + "]},";
    }
    writeText(*sFolder / "shared.gltf",
              R"({"cameras": [], "nodes": [)" + nodes + R"({"name": "last"}]})");
    const RunResult result = render({"cube.vdb", "-o", "x.png", "--camera-file", "shared.gltf"});
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_NE(result.err.find("no camera"), std::string::npos) << result.err;
}

TEST_F(RenderScene, FlagsOfASceneFileAreTrueOrFalse) {
    for (const char* bad : {R"("false")", "0", R"("no")"}) {
        writeText(*sFolder / "flag.json", R"({"objects": [{"file": "cube.vdb"}],
            "picture": {"res": [8, 8], "shadows": )" +
                                              std::string(bad) + "}}");
        const RunResult result = render({"flag.json", "-o", "x.png"});
        EXPECT_EQ(result.status, 3) << bad << result.err;
        EXPECT_NE(result.err.find("shadows is neither true nor false"), std::string::npos)
            << result.err;
    }
    writeText(*sFolder / "value.json", R"({"objects": [{"file": "cube.vdb", "roughness": true}]})");
    EXPECT_EQ(render({"value.json", "-o", "x.png"}).status, 3);
}

TEST_F(RenderScene, APreviewLeavesWhatItCannotReplace) {
    writeText(*sFolder / "keep.png", "old");
    const RunResult away = render({"cube.vdb", "-o", "keep.png", "--res", "16x16", "--eye", "0,0,9",
                                   "--lookat", "0,0,99", "--preview", "0"});
    EXPECT_EQ(away.status, 4) << away.err;
    EXPECT_EQ(readText(*sFolder / "keep.png"), "old");
    std::filesystem::create_symlink("/dev/null", *sFolder / "null.png");
    const RunResult device =
        render({"cube.vdb", "-o", "null.png", "--res", "16x16", "--preview", "0"});
    EXPECT_EQ(device.status, 2) << device.err;
}

TEST_F(RenderScene, ANameWithANumberSignIsAFileIfItIsThere) {
    std::filesystem::copy_file(*sFolder / "cube.vdb", *sFolder / "part#2.vdb");
    EXPECT_EQ(render({"part#2.vdb", "-o", "part.png", "--res", "8x8"}).status, 0);
    EXPECT_EQ(render({"cube.vdb", "-o", "x.#.png", "--turntable", "4", "--frames", "0-2"}).status,
              2);
    EXPECT_EQ(render({"cube.vdb", "-o", "x.png", "--scale", "1e-9"}).status, 2);
}

TEST_F(RenderScene, ColorsAndLightsThatAreNoneAreRefused) {
    const auto grids = readVdb(*sFolder / "sphere.vdb");
    for (const float bad : {std::nanf(""), HUGE_VALF, 3e38F}) {
        auto colors = openvdb::Vec3SGrid::create();
        colors->setName("Cd");
        colors->tree().setValue(openvdb::Coord(0), openvdb::Vec3f(0.5F, bad, 0.5F));
        writeGrids("bad.vdb", {grids.at(0), colors});
        const RunResult result = render({"bad.vdb", "-o", "x.png", "--res", "8x8"});
        EXPECT_EQ(result.status, 3) << bad << result.err;
        EXPECT_NE(result.err.find("Cd"), std::string::npos) << result.err;
    }
    writeText(*sFolder / "lit.json", R"({"objects": [{"file": "cube.vdb"}]})");
    EXPECT_EQ(render({"lit.json", "-o", "x.png", "--light", "1,0,0"}).status, 2);
}

TEST_F(RenderScene, LevelSetsAreSpokenOfAsSuch) {
    auto grid =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1, openvdb::Vec3f(0), 0.1F);
    writeGrids("ball.vdb", {grid});
    const RunResult beyond = render({"ball.vdb", "-o", "x.png", "--iso", "5"});
    EXPECT_EQ(beyond.status, 2);
    EXPECT_NE(beyond.err.find("below the level set's background"), std::string::npos) << beyond.err;
    const RunResult within = render({"ball.vdb", "-o", "x.png", "--iso=-4"});
    EXPECT_EQ(within.status, 4) << within.err;
    EXPECT_NE(within.err.find("above the iso-value -4"), std::string::npos) << within.err;
}

TEST_F(RenderScene, SaysOfAPictureHowItWasTaken) {
    ASSERT_EQ(render({"cube.vdb", "-o", "said.exr", "--eye", "1,2,6", "--lookat", "0,0,0", "--res",
                      "30x20", "--samples", "2"})
                  .status,
              0);
    const OIIO::ImageSpec spec = read("said.exr").spec;
    EXPECT_EQ(spec.get_string_attribute("bandvox_eye"), "1,2,6");
    EXPECT_EQ(spec.get_int_attribute("bandvox_samples"), 2);
    EXPECT_GT(spec.get_float_attribute("bandvox_seconds"), 0);
    EXPECT_NE(spec.find_attribute("worldtocamera"), nullptr);
    EXPECT_NE(spec.find_attribute("worldToNDC"), nullptr);
}

TEST_F(RenderScene, FewMegabytesOfCacheChangeNothing) {
    const Names view{"--res", "48x48"};
    ASSERT_EQ(render(with({"sphere.vdb", "-o", "much.exr"}, view)).status, 0);
    ASSERT_EQ(render(with({"sphere.vdb", "-o", "little.exr", "--cache-size", "1"}, view)).status,
              0);
    EXPECT_EQ(read("much.exr").pixels, read("little.exr").pixels);
}

}  // namespace
}  // namespace bandvox::app_test
