// Outputs that say how they were made: --like, --skip-existing.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class Stamp : public testing::Test {
  protected:
    Stamp() { writeText(mFolder / "cube.obj", cubeObj()); }

    RunResult run(const Names& arguments) {
        return runBandvox(arguments, {.folder = mFolder.path()});
    }
    void expectRuns(const Names& arguments) {
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, 0) << testing::PrintToString(arguments) << result.err;
    }

    /// Expects that converting again is skipped, and leaves the output as it is.
    void expectSkipped(Names arguments, const std::string& output) {
        const std::string before = readText(mFolder / output);
        arguments.emplace_back("--skip-existing");
        const RunResult result = run(arguments);
        SCOPED_TRACE(testing::PrintToString(arguments) + result.err);
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(countLines(result.err, "skipped  " + output), 1);
        EXPECT_EQ(readText(mFolder / output), before);
    }
    /// Expects that it is done again, because of `why`.
    void expectRedone(Names arguments, const std::string& why) {
        arguments.emplace_back("--skip-existing");
        const RunResult result = run(arguments);
        SCOPED_TRACE(testing::PrintToString(arguments) + result.err);
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(countLines(result.err, "skipped"), 0);
        EXPECT_EQ(countLines(result.err, "redo     "), why.empty() ? 0 : 1);
        EXPECT_NE(result.err.find(why), std::string::npos) << why;
        EXPECT_EQ(countLines(result.err, "wrote"), 1);
    }

    std::string settings(const std::string& name) {
        const RunResult result = run({"info", name, "--json"});
        return nlohmann::json::parse(result.out)["grids"][0]["bandvox"]["settings"];
    }

    /// A file without the identity that OpenVDB gives to each.
    std::string content(const std::string& name) { return readText(mFolder / name).erase(20, 40); }

    TemporaryFolder mFolder;
};

TEST_F(Stamp, SettingsAreCompleteAndHoldNothingOfTheMachine) {
    expectRuns({"convert", "cube.obj", "-o", "a.vdb", "-r", "16", "--threads", "1", "--lod", "1"});
    const std::string version = run({"--version"}).out;
    EXPECT_EQ(settings("a.vdb"),
              "# solid to volume by " + version +
                  "as=density # default\nclamp=false\ncolor=false\ncompression=blosc # default\n"
                  "cutoff=0.16 # default\nhalf=false\niso=0.5 # default\nlod=1\n"
                  "order=2 # default\noverlap=union # default\noversample=4 # default\n"
                  "resolution=16\nroute=auto # default\ntile=0 # default\n"
                  "tolerance=1e-04 # default");
    const RunResult info = run({"info", "a.vdb"});
    EXPECT_EQ(countLines(info.out, "      resolution=16"), 2) << info.out;
    EXPECT_EQ(info.out.find(mFolder.path().string()), std::string::npos) << info.out;
    // The same anywhere, by any number of threads, in any order.
    std::filesystem::create_directory(mFolder / "sub");
    expectRuns({"convert", (mFolder / "cube.obj").string(), "--lod", "1", "--resolution", "016",
                "-o", (mFolder / "sub/b.vdb").string(), "--quiet"});
    EXPECT_EQ(content("sub/b.vdb"), content("a.vdb"));
}

TEST_F(Stamp, TheInputIsToldByItsDigest) {
    expectRuns({"convert", "cube.obj", "-o", "a.vdb", "-r", "16"});
    if (!hasProgram("sha256sum")) GTEST_SKIP() << "there is no sha256sum";
    const std::string sum =
        runProgram({"sha256sum", "cube.obj"}, {.folder = mFolder.path()}).out.substr(0, 64);
    const RunResult info = run({"info", "a.vdb"});
    EXPECT_NE(info.out.find("input: " + sum + " " + std::to_string(cubeObj().size()) + " cube.obj"),
              std::string::npos)
        << info.out;
}

TEST_F(Stamp, LikeRepeatsWhatWasDone) {
    const std::vector<std::pair<std::string, Names>> cases{
        {"cube.obj", {"-r", "16"}},
        {"cube.obj", {"--voxel-size", "0.1", "--half", "--compression", "zip", "--clamp"}},
        {"cube.obj", {"-r", "16", "--route", "winding", "--oversample", "2", "--iso", "0.4"}},
        {"cube.obj", {"-r", "16", "--tolerance", "1e-3", "--order", "4", "--cutoff", "0.25"}},
        {"cube.obj", {"-r", "16", "--overlap", "sum", "--tile", "32", "--lod", "2"}},
        {"shape:torus", {"-r", "16", "--route", "sampled"}},
        {"volume.vdb", {"--factor", "2"}},
        {"volume.vdb", {"--resolution", "8", "--no-filter", "--grid", "density"}},
        {"volume.vdb", {"--onto", "other.vdb"}},
        {"volume.vdb", {"--lod", "1"}},
        {"volume.vdb", {"--order", "3", "--iso", "0.3"}},
        {"volume.vdb", {}},
        {"cube.obj", {"-r", "16", "--as", "level-set", "--band", "4"}},
        {"cube.obj", {"-r", "16", "--as", "fog", "--iso", "volume"}},
        {"volume.vdb", {"--as", "level-set"}},
        {"volume.vdb", {"--as", "density", "--factor", "2", "--order", "3"}},
        {"volume.vdb", {"--threshold", "0.3", "--tile", "32"}},
        {"volume.vdb", {"--as", "values", "--half"}},
    };
    expectRuns({"convert", "cube.obj", "-o", "volume.vdb", "-r", "16"});
    expectRuns({"convert", "shape:sphere", "-o", "other.vdb", "-r", "9"});
    for (const auto& [input, options] : cases) {
        Names first{"convert", input, "-o", "first.vdb"};
        first.insert(first.end(), options.begin(), options.end());
        expectRuns(first);
        expectRuns({"convert", input, "-o", "second.vdb", "--like", "first.vdb"});
        EXPECT_EQ(content("second.vdb"), content("first.vdb")) << testing::PrintToString(first);
        expectSkipped(first, "first.vdb");
        expectSkipped({"convert", input, "-o", "first.vdb", "--like", "second.vdb"}, "first.vdb");
    }
}

TEST_F(Stamp, OptionsWinOverLike) {
    expectRuns({"convert", "cube.obj", "-o", "a.vdb", "-r", "16", "--half", "--order", "3"});
    expectRuns({"convert", "cube.obj", "-o", "b.vdb", "--like", "a.vdb", "--voxel-size", "0.25",
                "--half=false"});
    const std::string found = settings("b.vdb");
    EXPECT_NE(found.find("voxel-size=0.25"), std::string::npos) << found;
    EXPECT_EQ(found.find("resolution"), std::string::npos) << found;
    EXPECT_NE(found.find("half=false"), std::string::npos) << found;
    EXPECT_NE(found.find("order=3\n"), std::string::npos) << found;
    writeText(mFolder / "c.cfg", "order = 4\nlike = a.vdb\n");
    expectRuns({"convert", "cube.obj", "-o", "c.vdb", "--config", "c.cfg"});
    EXPECT_NE(settings("c.vdb").find("order=4\n"), std::string::npos) << settings("c.vdb");
    EXPECT_NE(settings("c.vdb").find("resolution=16\n"), std::string::npos) << settings("c.vdb");
}

TEST_F(Stamp, LikeLeavesOutWhatHasNoMeaning) {
    expectRuns({"convert", "cube.obj", "-o", "a.vdb", "-r", "16", "--lod", "1", "--route", "auto",
                "--half"});
    expectRuns({"convert", "cube.obj", "-o", "a.ply", "--like", "a.vdb"});
    expectRuns({"convert", "a.vdb", "-o", "b.vdb", "--like", "a.vdb"});
    expectRuns({"convert", "a.vdb", "-o", "b.ply", "--like", "a.vdb", "--grid", "density"});
    // And a mesh's settings are good for a volume.
    expectRuns({"convert", "cube.obj", "-o", "c.vdb", "--like", "a.ply"});
    EXPECT_NE(settings("c.vdb").find("resolution=16\n"), std::string::npos);
}

TEST_F(Stamp, LikeNeedsAFileWithSettings) {
    writeSeveralGrids(mFolder / "foreign.vdb");
    for (const std::string name : {"foreign.vdb", "none.vdb", "none.ply", "cube.obj"}) {
        const RunResult result =
            run({"convert", "shape:cube", "-o", "a.vdb", "-r", "8", "--like", name});
        EXPECT_EQ(result.status, 3) << result.err;
        EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
    }
    EXPECT_EQ(run({"convert", "cube.obj", "-o", "a.vdb", "--like", "a.vdb"}).status, 3);
    expectRuns({"convert", "cube.obj", "-o", "a.vdb", "-r", "8"});
    EXPECT_EQ(run({"convert", "cube.obj", "-o", "a.vdb", "--like", "a.vdb"}).status, 2);
}

TEST_F(Stamp, SkipsOnlyWhatWouldBeTheSame) {
    const Names convert{"convert", "cube.obj", "-o", "a.vdb", "-r", "16"};
    expectRedone(convert, "");
    expectSkipped(convert, "a.vdb");
    const auto with = [&](const Names& options) {
        Names all = convert;
        all.insert(all.end(), options.begin(), options.end());
        return all;
    };
    // Neither of these changes the result.
    expectSkipped(with({"--threads", "1", "--verbose"}), "a.vdb");
    expectSkipped(with({"--order", "2.0", "--route", "auto"}), "a.vdb");
    expectRedone(with({"--order", "3"}), "order was 2, is 3");
    expectRedone(with({"--half"}), "half was false, is true");
    expectRedone(convert, "half was true, is false");
    expectSkipped(convert, "a.vdb");
    // An input that was only touched is the same; another content is not, nor another name.
    std::filesystem::last_write_time(mFolder / "cube.obj",
                                     std::filesystem::file_time_type::clock::now());
    expectSkipped(convert, "a.vdb");
    writeText(mFolder / "cube.obj", openCubeObj());
    expectRedone(convert, "the input has changed: cube.obj");
    std::filesystem::copy(mFolder / "cube.obj", mFolder / "copy.obj");
    Names renamed = convert;
    renamed[1] = "copy.obj";
    expectRedone(renamed, "copy.obj");
}

TEST_F(Stamp, WhatIsNotWholeIsDoneAgain) {
    const Names convert{"convert", "cube.obj", "-o", "a.vdb", "-r", "16"};
    expectRuns(convert);
    const std::string whole = readText(mFolder / "a.vdb");
    for (const double part : {0.0, 0.01, 0.3, 0.9, 0.999}) {
        const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
        writeText(mFolder / "a.vdb", whole.substr(0, size));
        expectRedone(convert, "a.vdb");
        EXPECT_EQ(content("a.vdb"), std::string(whole).erase(20, 40));
    }
    writeSeveralGrids(mFolder / "a.vdb");
    expectRedone(convert, "does not say");
}

TEST_F(Stamp, MeshesSayItToo) {
    for (const std::string name : {"a.ply", "a.obj", "a.glb", "a.gltf"}) {
        const Names convert{"convert", "cube.obj", "-o", name, "-r", "16"};
        expectRedone(convert, "");
        expectSkipped(convert, name);
        Names other = convert;
        other.insert(other.end(), {"--adaptivity", "0.5"});
        expectRedone(other, "adaptivity was 0, is 0.5");
        const std::string whole = readText(mFolder / name);
        writeText(mFolder / name, whole.substr(0, whole.size() * 9 / 10));
        expectRedone(other, name);
        expectSkipped(other, name);
        // One digit of a coordinate, which leaves a mesh that can be read.
        std::string changed = whole;
        changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] ^ 1);
        writeText(mFolder / name, changed);
        expectRedone(other, "checksum");
    }
    const RunResult stl =
        run({"convert", "cube.obj", "-o", "a.stl", "-r", "16", "--skip-existing"});
    EXPECT_EQ(stl.status, 2);
    EXPECT_NE(stl.err.find("a.stl"), std::string::npos) << stl.err;
    EXPECT_EQ(run({"convert", "stdin.vdb", "-o", "a.vdb", "--skip-existing"}).status, 2);
}

TEST_F(Stamp, FilesThatAnInputNamesBelongToIt) {
    writeText(mFolder / "cube.obj", "mtllib cube.mtl\nusemtl m\n" + cubeObj());
    writeText(mFolder / "cube.mtl", "newmtl m\nKd 1 0 0\n");
    const Names colored{"convert", "cube.obj", "-o", "a.vdb", "-r", "16", "--color"};
    const Names plain{"convert", "cube.obj", "-o", "b.vdb", "-r", "16"};
    expectRuns(colored);
    expectRuns(plain);
    expectSkipped(colored, "a.vdb");
    writeText(mFolder / "cube.mtl", "newmtl m\nKd 0 1 0\n");
    expectRedone(colored, "the input has changed: cube.mtl");
    expectSkipped(plain, "b.vdb");

    writeText(mFolder / "a.raw", std::string(4 * 4 * 4, '\1'));
    writeText(mFolder / "a.mhd",
              "NDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = a.raw\n");
    const Names array{"convert", "a.mhd", "-o", "c.vdb"};
    expectRuns(array);
    expectSkipped(array, "c.vdb");
    writeText(mFolder / "a.raw", std::string(4 * 4 * 4, '\2'));
    expectRedone(array, "the input has changed: a.raw");

    expectRuns({"convert", "shape:sphere", "-o", "lattice.vdb", "-r", "9"});
    const Names onto{"convert", "b.vdb", "-o", "d.vdb", "--onto", "lattice.vdb"};
    expectRuns(onto);
    expectSkipped(onto, "d.vdb");
    expectRuns({"convert", "shape:sphere", "-o", "lattice.vdb", "-r", "10"});
    expectRedone(onto, "onto was lattice:");
}

TEST_F(Stamp, FramesAreSkippedOneByOne) {
    for (const char* name : {"f.1.obj", "f.2.obj", "f.3.obj"}) {
        writeText(mFolder / name, cubeObj());
    }
    const Names convert{"convert", "f.#.obj",         "-o",      "f.#.vdb", "-r",
                        "16",      "--skip-existing", "--stats", "s.json"};
    expectRuns(convert);
    writeText(mFolder / "f.2.obj", openCubeObj());
    const RunResult result = run(convert);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "skipped  "), 2) << result.err;
    EXPECT_EQ(countLines(result.err, "redo     f.2.vdb: the input has changed: f.2.obj"), 1)
        << result.err;
    const auto statistics = nlohmann::json::parse(readText(mFolder / "s.json"));
    EXPECT_EQ(statistics["frames"][0]["result"], "skipped");
    EXPECT_EQ(statistics["frames"][1]["result"], "written");
    EXPECT_EQ(statistics["counts"]["frames_skipped"], 2);
}

TEST_F(Stamp, ACopyOfAVolumeHasSettingsOfItsOwn) {
    expectRuns({"convert", "cube.obj", "-o", "a.vdb", "-r", "16"});
    expectRuns({"convert", "a.vdb", "-o", "b.vdb", "--compression", "none"});
    EXPECT_TRUE(settings("b.vdb").starts_with("# volume to volume by")) << settings("b.vdb");
    EXPECT_NE(run({"info", "b.vdb"}).out.find(" a.vdb\n"), std::string::npos);
}

}  // namespace
}  // namespace bandvox::app_test
