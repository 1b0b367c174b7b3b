// Which files and options the outline command takes, and which it refuses.

#include "outline_inputs.h"
#include "run_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

const std::string kFlatPatch = "1\n1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    return text.replace(at, from.size(), to);
}

TEST(OutlineInput, SaysThatAFolderIsNoFile) {
    const TemporaryFolder folder;
    for (const char* const name : {"patches.bpt", "patches.obj"}) {
        std::filesystem::create_directory(folder / name);
        const RunResult result =
            runBandvox({"outline", name, "-o", "out.svg"}, {.folder = folder.path()});
        EXPECT_EQ(result.status, 3) << result.err;
        EXPECT_NE(result.err.find("folder"), std::string::npos) << result.err;
    }
}

TEST(OutlineInput, RefusesOptionsOfVolumesThatHaveNoUse) {
    const TemporaryFolder folder;
    const auto statusOf = [&](Names words) {
        words.insert(words.begin(), "outline");
        words.insert(words.end(), {"-o", "out.svg"});
        return runBandvox(words, {.folder = folder.path()}).status;
    };
    ASSERT_EQ(runBandvox({"convert", "shape:sphere", "-r", "16", "-o", "ball.vdb"},
                         {.folder = folder.path()})
                  .status,
              0);
    EXPECT_EQ(statusOf({kTeapotFile, "-r", "64"}), 2);
    EXPECT_EQ(statusOf({kTeapotFile, "--iso", "0.5"}), 2);
    EXPECT_EQ(statusOf({kTeapotFile, "--suggestive", "5"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--suggestive", "-5"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--suggestive", "5"}), 0);
    EXPECT_EQ(statusOf({"ball.vdb", "--suggestive", "5", "--kinds", "contour"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--crease-angle", "5"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--order", "4"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--isophotes", "1"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--light", "0,0,0"}), 2);
    EXPECT_EQ(statusOf({"shape:sphere", "--grid", "density"}), 2);
    EXPECT_EQ(statusOf({"ball.vdb", "--iso", "1.5"}), 4);
    EXPECT_EQ(statusOf({"ball.vdb", "--grid", "other"}), 3);
    EXPECT_EQ(statusOf({"nothing.vdb"}), 3);
    EXPECT_EQ(statusOf({"picture.png"}), 3);
}

TEST(OutlineInput, RefusesOptionsThatChangeNothing) {
    const TemporaryFolder folder;
    const std::vector<Names> idle{
        {"--no-hidden", "--dash", "1 1"},
        {"--no-hidden", "--hidden-stroke", "0.1"},
        {"--no-hidden", "--hidden-color", "#888888"},
        {"--camera", "orthographic", "--focal", "50"},
        {"--camera", "orthographic", "--fov", "40"},
        {"--camera", "orthographic", "--aperture", "20"},
        {"--eye", "0,-20,5", "--from", "0,-1,0"},
        {"--light", "0,0,1"},
        {"--light", "0,0,1", "--fill", "flat"},
        {"--isophotes", "0.5", "--kinds", "contour,crease"},
        {"--crease-angle", "10", "--kinds", "contour"},
        {"--tones", "0.5"},
        {"--shade", "0.5", "--fill", "flat"},
        {"--fill-colors", "#123456"},
    };
    for (const Names& options : idle) {
        Names words{"outline", kTeapotFile, "-o", "out.svg"};
        words.insert(words.end(), options.begin(), options.end());
        const RunResult found = runBandvox(words, {.folder = folder.path()});
        EXPECT_EQ(found.status, 2) << options.back() << found.err;
        EXPECT_NE(found.err.find("expected"), std::string::npos) << found.err;
    }
    const std::vector<Names> used{
        {"--light", "0,0,1", "--isophotes", "0.5"},
        {"--light", "0,0,1", "--fill", "toon", "--no-hidden"},
        {"--dash", "1 1", "--hidden-stroke", "0.1"},
        {"--eye", "0,-20,5", "--focal", "50"},
        {"--from", "0,-1,0", "--camera", "orthographic", "--frame", "9"},
    };
    for (const Names& options : used) {
        Names words{"outline", kTeapotFile, "-o", "out.svg"};
        words.insert(words.end(), options.begin(), options.end());
        EXPECT_EQ(runBandvox(words, {.folder = folder.path()}).status, 0) << options.back();
    }
}

// A file of options may hold what a drawing has no use for.
TEST(OutlineInput, TakesOptionsOfAFileThatChangeNothing) {
    const TemporaryFolder folder;
    const RunOptions here{.folder = folder.path()};
    writeText(folder.path() / "house.cfg", "from = 1,1,1\nfocal = 35\ndash = 1 1\ntones = 0.5\n");
    const std::vector<Names> lines{
        {"--eye", "0,-20,5"}, {"--camera", "orthographic"}, {"--no-hidden"}, {"--fill", "flat"}};
    for (const Names& options : lines) {
        Names words{"outline", kTeapotFile, "-o", "out.svg", "--config", "house.cfg"};
        words.insert(words.end(), options.begin(), options.end());
        const RunResult found = runBandvox(words, here);
        EXPECT_EQ(found.status, 0) << options.front() << found.err;
    }
}

TEST(OutlineInput, RefusesBrokenFiles) {
    struct Broken {
        std::string name, text, words;
        int status = 3;
    };
    std::string points = "1000\n";
    for (int k = 0; k < 1000; ++k) points += "1 1\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n";
    const std::vector<Broken> all{
        {"a.bpt", "", "the number of patches"},
        {"a.bpt", "2\n" + kFlatPatch.substr(2), "announces 2 patches"},
        {"a.bpt", "2\n" + kFlatPatch.substr(2) + "# " + std::string(40, 'x') + "\n",
         "patch 2 of 2"},
        {"a.bpt", "1\n1 1\n0.0000000 0 0\n1.0000000 0 0\n0 0", "expected points of patch 1 of 1"},
        {"a.bpt", kFlatPatch + "7\n", "line 7 goes on"},
        {"a.bpt", replaced(kFlatPatch, "1 1", "0 1"), "line 2 has the degree 0"},
        {"a.bpt", replaced(kFlatPatch, "1 1", "1 99"), "line 2 has the degree 99"},
        {"a.bpt", replaced(kFlatPatch, "0 1 0", "0 nan 0"), "line 5"},
        {"a.bpt", replaced(kFlatPatch, "0 1 0", "0 inf 0"), "line 5"},
        {"a.bpt", "999999999999\n1 1\n", "announces"},
        {"a.bpt", "0\n", "empty", 4},
        {"a.bpt", points, "empty", 4},
        {"a.obj", kCylinder.substr(0, kCylinder.size() - 4), "ends within the surface of line 9"},
        {"a.obj", replaced(kCylinder, "0.7071067811865476", "0"), "weight"},
        {"a.obj", replaced(kCylinder, "0.7071067811865476", "-1"), "weight"},
        {"a.obj", replaced(kCylinder, "deg 2 1", "deg 0 1"), "line 8 has the degree 0"},
        {"a.obj", replaced(kCylinder, "4 5 6", "4 5"), "5 points; expected 3 x 2"},
        {"a.obj", replaced(kCylinder, "4 5 6", "4 5 7"), "point \"7\""},
        {"a.obj", replaced(kCylinder, "rat bezier", "cardinal"), "cardinal"},
        {"a.obj", replaced(kCylinder, "parm u 0 1", "parm u 1 0"), "descends"},
        {"a.obj", replaced(kCylinder, "parm u 0 1", "parm u 0 0"), "nothing between"},
        {"a.obj", replaced(kCylinder, "surf 0 1", "surf 0 0"), "expected it to rise"},
        {"a.obj", replaced(kCylinder, "parm u 0 1", "trim 0 1 1"), "trims"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "the mesh is flat", 4},
        {"a.obj", "surf 0 1 0 1 1 2 3 4\n", "line 1"},
        {"a.step", "", "is empty"},
        {"a.step", "ISO-10303-21;\nHEADER;\n", "ends before END-ISO-10303-21"},
        {"a.igs", kFlatPatch, "expected an IGES file"},
        {"a.brep", kFlatPatch, "expected a BREP file"},
#ifndef BANDVOX_WITH_OPENCASCADE
        {"a.stp", "ISO-10303-21;\nEND-ISO-10303-21;\n", "scripts/setup --cad"},
#endif
        {"a.txt", kFlatPatch, "expected a .vdb, free-form surfaces (.bpt, .obj, .step"},
    };
    for (const Broken& broken : all) {
        const TemporaryFolder folder;
        writeText(folder / broken.name, broken.text);
        const RunResult result =
            runBandvox({"outline", broken.name, "-o", "out.svg"}, {.folder = folder.path()});
        EXPECT_EQ(result.status, broken.status) << broken.words << ": " << result.err;
        EXPECT_NE(result.err.find(broken.words), std::string::npos) << result.err;
        EXPECT_EQ(folder.contents(), Names{broken.name});
    }
    EXPECT_EQ(runBandvox({"outline", "/nowhere.bpt", "-o", "/tmp/out.svg"}).status, 3);
}

TEST(OutlineInput, IsXmlWhateverTheNamesOfObjects) {
    const TemporaryFolder folder;
    // Latin-1, a character that XML does not have, and one that it has.
    const std::string names = "o caf\xe9-\xef\xbf\xbe-\xc3\xa9<\n";
    writeText(folder / "cylinder.obj", replaced(kCylinder, "cstype", names + "cstype"));
    const RunResult result =
        runBandvox({"outline", "cylinder.obj", "-o", "out.svg"}, {.folder = folder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(readText(folder / "out.svg").find("\"caf_-___-\xc3\xa9&lt;\""), std::string::npos);
}

TEST(OutlineInput, SeesAllOfWhatControlPointsReachFarBeyond) {
    const TemporaryFolder folder;
    // A control point of small weight is far before the surface.
    writeText(
        folder / "half.obj",
        "v 1 0 0\nv 0 0 0 0.1\nv -1 0 0\nv 1 0 1\nv 0 40 1 0.1\nv -1 0 1\n"
        "cstype rat bezier\ndeg 2 1\nsurf 0 1 0 1 1 2 3 4 5 6\nparm u 0 1\nparm v 0 1\nend\n");
    const RunResult result =
        runBandvox({"outline", "half.obj", "-o", "out.svg", "--from", "0,1,0.1", "--up", "0,0,1"},
                   {.folder = folder.path()});
    EXPECT_EQ(result.status, 0) << result.err;
}

TEST(OutlineInput, OfALineThatIsSeenAlongItselfIsEmpty) {
    const TemporaryFolder folder;
    writeText(folder / "line.bpt", "1\n1 1\n0 0 0\n0 0 1\n0 0 0\n0 0 1\n");
    for (const std::string camera : {"perspective", "orthographic"}) {
        const RunResult result = runBandvox(
            {"outline", "line.bpt", "-o", "out.svg", "--camera", camera, "--from", "0,0,1"},
            {.folder = folder.path()});
        EXPECT_EQ(result.status, 4) << camera << ": " << result.err;
        EXPECT_NE(result.err.find("the drawing is empty"), std::string::npos) << result.err;
    }
}

TEST(OutlineInput, DrawsAFlatPatchByItsBoundary) {
    const TemporaryFolder folder;
    writeText(folder / "flat.bpt", kFlatPatch);
    const RunResult result = runBandvox(
        {"outline", "flat.bpt", "-o", "out.svg", "--camera", "orthographic", "--from", "0,0,1"},
        {.folder = folder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string svg = readText(folder / "out.svg");
    EXPECT_EQ(occurrences(svg, "<path id"), 1U);
    EXPECT_EQ(occurrences(svg, " Z\""), 1U);
    EXPECT_EQ(occurrences(svg, " C"), 4U);
}

}  // namespace
}  // namespace bandvox::app_test
