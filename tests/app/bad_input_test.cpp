// Input, output and sizes that cannot be used: each has its exit status, one line that says why,
// and leaves nothing behind.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <utility>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

class BadInput : public testing::Test {
  protected:
    /// Expects the status, one line of error that holds all `words`, and no new file.
    void expectFailure(const Names& arguments, int status, const Names& words,
                       RunOptions options = {}) {
        const Names before = mFolder.contents();
        options.folder = mFolder.path();
        const RunResult result = runBandvox(arguments, options);
        SCOPED_TRACE(testing::PrintToString(arguments) + " said: " + result.err);
        EXPECT_EQ(result.status, status);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1);
        for (const std::string& word : words) {
            EXPECT_NE(result.err.find(word), std::string::npos) << word;
        }
        EXPECT_EQ(mFolder.contents(), before);
    }

    /// The same for a mesh file of that content under convert.
    void expectBadMesh(const std::string& name, const std::string& content, int status,
                       const Names& words = {}) {
        writeText(mFolder / name, content);
        Names all = words;
        if (status == 3) all.push_back(name);
        expectFailure({"convert", name, "-o", "out.vdb", "-r", "16"}, status, all);
    }

    TemporaryFolder mFolder;
};

TEST_F(BadInput, MissingFile) {
    expectFailure({"convert", "none.obj", "-o", "out.vdb"}, 3, {"none.obj"});
    expectFailure({"render", "none.vdb", "-o", "out.png"}, 3, {"none.vdb"});
    expectFailure({"info", "none.vdb"}, 3, {"none.vdb"});
}

TEST_F(BadInput, Folder) {
    std::filesystem::create_directory(mFolder / "dir.obj");
    std::filesystem::create_directory(mFolder / "dir.vdb");
    expectFailure({"convert", "dir.obj", "-o", "out.vdb"}, 3, {"dir.obj"});
    expectFailure({"render", "dir.vdb", "-o", "out.png"}, 3, {"dir.vdb"});
    expectFailure({"info", "dir.vdb"}, 3, {"dir.vdb"});
}

TEST_F(BadInput, UnknownKind) {
    writeText(mFolder / "cube.abc", cubeObj());
    writeText(mFolder / "cube.vdb", "");
    writeText(mFolder / "cube.obj", cubeObj());
    writeText(mFolder / "cube", cubeObj());
    expectFailure({"convert", "cube.abc", "-o", "out.vdb"}, 3, {"'.abc'", ".obj", "shape:"});
    expectFailure({"convert", "cube", "-o", "out.vdb"}, 3, {"extension", ".obj"});
    expectFailure({"convert", "cube.vdb", "-o", "out.vdb"}, 3, {"cube.vdb", "empty"});
    expectFailure({"convert", "shape:blob", "-o", "out.vdb"}, 3, {"blob", "torus"});
    expectFailure({"convert", "shape:", "-o", "out.vdb"}, 3, {"torus"});
    expectFailure({"convert", "", "-o", "out.vdb"}, 3, {});
    expectFailure({"render", "cube.obj", "-o", "out.png"}, 3,
                  {"bandvox convert cube.obj -o cube.vdb"});
    expectFailure({"render", "shape:cube", "-o", "out.png"}, 3,
                  {"bandvox convert shape:cube -o cube.vdb"});
    expectFailure({"render", "cube.txt", "-o", "out.png"}, 3, {"cube.txt", ".vdb"});
    expectFailure({"info", "cube.txt"}, 3, {"cube.txt", ".vdb"});
}

TEST_F(BadInput, EmptyFile) {
    for (const char* name :
         {"a.obj", "a.ply", "a.stl", "a.off", "a.gltf", "a.glb", "a.fbx", "a.dae"}) {
        expectBadMesh(name, "", 3);
    }
    writeText(mFolder / "a.vdb", "");
    expectFailure({"render", "a.vdb", "-o", "out.png"}, 3, {"a.vdb"});
    expectFailure({"info", "a.vdb"}, 3, {"a.vdb"});
}

TEST_F(BadInput, TruncatedMesh) {
    // An obj may end anywhere between two lines; cut in the points, its faces are missing.
    expectBadMesh("cut.obj", cubeObj().substr(0, 60), 3);
    expectBadMesh("cut.ply", cubePly().substr(0, cubePly().size() - 20), 3);
    expectBadMesh("head.ply", cubePly().substr(0, 60), 3);
    expectBadMesh("cut.stl", cubeStlBinary().substr(0, 300), 3);
    expectBadMesh("text.stl", cubeStlAscii().substr(0, cubeStlAscii().size() / 2), 3);
    expectBadMesh("cut.glb", cubeGlb().substr(0, cubeGlb().size() - 40), 3);
    expectBadMesh("head.glb", cubeGlb().substr(0, 30), 3);
}

TEST_F(BadInput, TruncatedSceneAnywhere) {
    const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}]})";
    const std::pair<const char*, std::string> files[] = {{"whole.fbx", exportedCube("fbx")},
                                                         {"text.fbx", exportedCube("fbxa")},
                                                         {"whole.dae", exportedCube("collada")},
                                                         {"whole.gltf", gltf}};
    for (const auto& [name, content] : files) {
        for (const std::size_t part : {1, 5, 9}) {
            expectBadMesh(name, content.substr(0, content.size() * part / 10), 3);
        }
    }
}

TEST_F(BadInput, NestedTooDeep) {
    const auto repeated = [](const std::string& text) {
        std::string all;
        for (int i = 0; i < 200000; ++i) all += text;
        return all;
    };
    expectBadMesh("deep.gltf", R"({"asset":{"version":"2.0"},"x":)" + repeated("["), 3, {"nested"});
    expectBadMesh("deep.dae", repeated("<node>"), 3, {"nested"});
    expectBadMesh("deep.fbx", repeated("A: {"), 3, {"nested"});
}

TEST_F(BadInput, Rubbish) {
    for (const char* name : {"r.obj", "r.ply", "r.stl", "r.off", "r.gltf", "r.glb", "r.dae"}) {
        expectBadMesh(name, "\x01\x02 this is no mesh\n\xff\xfe\n", 3);
    }
    writeText(mFolder / "r.vdb", "this is no volume");
    expectFailure({"render", "r.vdb", "-o", "out.png"}, 3, {"r.vdb"});
    expectFailure({"info", "r.vdb", "--json"}, 3, {"r.vdb"});
}

TEST_F(BadInput, NoFaces) {
    expectBadMesh("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", 3);
}

TEST_F(BadInput, CoordinatesThatAreNotFinite) {
    std::string text = cubeObj();
    text.replace(text.find("v -1 -1 -1"), 10, "v -1 nan -1");
    expectBadMesh("nan.obj", text, 3);
    std::string bytes = cubeStlBinary();
    const unsigned char infinity[4]{0, 0, 0x80, 0x7f};
    bytes.replace(80 + 4 + 12, 4, reinterpret_cast<const char*>(infinity), 4);
    expectBadMesh("inf.stl", bytes, 3);
}

TEST_F(BadInput, IndicesOutOfRange) {
    expectBadMesh("index.obj", cubeObj() + "f 1 2 99\n", 3);
    std::string ply = cubePly();
    ply.replace(ply.rfind("3 "), 3, "3 9");
    expectBadMesh("index.ply", ply, 3);
}

TEST_F(BadInput, FlatMesh) {
    expectBadMesh("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", 4);
}

TEST_F(BadInput, MoreMemoryThanThereIs) {
    writeText(mFolder / "cube.obj", cubeObj());
    expectFailure({"convert", "cube.obj", "-o", "out.vdb", "--voxel-size", "2e-5"}, 5, {"memory"});
    expectFailure({"convert", "shape:sphere", "-o", "out.vdb", "-r", "100000"}, 5, {"memory"});
}

TEST_F(BadInput, VoxelsBeyondAnyIndex) {
    expectFailure({"convert", "shape:cube", "-o", "out.vdb", "--voxel-size", "1e-300"}, 2,
                  {"voxel"});
    // OpenVDB refuses such transforms.
    expectFailure({"convert", "shape:cube", "-o", "out.vdb", "-r", "1000000"}, 3,
                  {"scale the object up"});
}

TEST_F(BadInput, OutputThatCannotBeWritten) {
    writeText(mFolder / "cube.obj", cubeObj());
    writeText(mFolder / "file", "");
    std::filesystem::create_directory(mFolder / "dir.vdb");
    for (const std::string output : {"none/out.vdb", "file/out.vdb", "dir.vdb", "/proc/out.vdb"}) {
        // Known before the work: not a word about the mesh.
        const RunResult result =
            runBandvox({"convert", "cube.obj", "-o", output}, {.folder = mFolder.path()});
        EXPECT_EQ(result.err.find("triangles"), std::string::npos) << result.err;
        expectFailure({"convert", "cube.obj", "-o", output}, 1, {output});
    }
    expectFailure({"convert", "cube.obj", "-o", "out.vdb", "--stats", "none/s.json"}, 1,
                  {"none/s.json"});
}

TEST_F(BadInput, FilesThatAreTheSame) {
    writeText(mFolder / "cube.obj", cubeObj());
    std::filesystem::create_symlink("y.vdb", mFolder / "link");
    std::filesystem::create_hard_link(mFolder / "cube.obj", mFolder / "other.obj");
    const std::string outside = "../" + mFolder.path().filename().string() + "/y.vdb";
    for (const std::string& stats : Names{"y.vdb", "./y.vdb", "link", outside}) {
        expectFailure({"convert", "cube.obj", "-o", "y.vdb", "--stats", stats}, 2,
                      {"--stats", "'" + stats + "'", "--output"});
    }
    for (const std::string stats : {"cube.obj", "other.obj"}) {
        expectFailure({"convert", "cube.obj", "-o", "y.vdb", "--stats", stats}, 2,
                      {"--stats", "'" + stats + "'", "INPUT"});
    }
    EXPECT_EQ(readText(mFolder / "cube.obj"), cubeObj());
    expectFailure({"info", "cube.vdb", "--stats", "cube.vdb"}, 2, {"INPUT"});
    expectFailure({"convert", "cube.obj", "-o", "stdout.vdb", "--stats", "/dev/stdout"}, 2,
                  {"--stats"});
    expectFailure({"convert", "cube.obj", "-o", "stdin.vdb"}, 2, {"stdin.vdb"});
}

TEST_F(BadInput, NamesOfNothingButAnExtension) {
    expectFailure({"convert", "cube.obj", "-o", ".vdb"}, 2, {"'.vdb'", "something before it"});
}

TEST_F(BadInput, ZerosAreQuoted) {
    writeText(mFolder / "zeros.off", std::string(20, '\0'));
    expectFailure({"convert", "zeros.off", "-o", "z.vdb"}, 3, {"line 1 begins with \"???", "OFF"});
}

TEST_F(BadInput, StatisticsThatCannotBeWritten) {
    // The result is whole, but there would be no record of it.
    std::filesystem::create_symlink("/dev/full", mFolder / "full");
    expectFailure({"convert", "shape:cube", "-o", "out.vdb", "-r", "16", "--stats", "full"}, 1,
                  {"full"});
    writeSeveralGrids(mFolder / "several.vdb");
    const RunResult result =
        runBandvox({"info", "several.vdb", "--stats", "s.json"},
                   {.folder = mFolder.path(), .standardOutput = "/dev/null", .largestFile = 100});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("'s.json'"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find(".bandvox-"), std::string::npos) << result.err;
}

TEST_F(BadInput, StatisticsWhoseNameIsTakenMeanwhile) {
    // A folder takes the statistics' name once the work has begun, so that they cannot get it.
    RunOptions options{.folder = mFolder.path()};
    options.signalWhen = [this](const std::string& said) {
        if (said.find("Progress: ") != std::string::npos) {
            std::filesystem::create_directory(mFolder / "s.json");
        }
        return 0;
    };
    const RunResult result = runBandvox({"convert", "shape:tree", "-o", "out.vdb", "-r", "200",
                                         "--progress", "always", "--stats", "s.json"},
                                        options);
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("cannot write s.json"), std::string::npos) << result.err;
    EXPECT_EQ(mFolder.contents(), Names{"s.json"});
}

TEST_F(BadInput, ReadOnlyFolder) {
    const auto folder = mFolder / "locked";
    std::filesystem::create_directory(folder);
    std::filesystem::permissions(
        folder, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    expectFailure({"convert", "shape:cube", "-o", "locked/out.vdb"}, 1, {"locked/out.vdb"},
                  {.heedPermissions = true});
}

TEST_F(BadInput, FullDisk) {
    // A limit on the size of files fails in the same way, and needs no disk of its own.
    const RunOptions full{.largestFile = 2000};
    expectFailure({"convert", "shape:torus", "-o", "out.vdb", "-r", "64"}, 1, {"out.vdb"}, full);
    ASSERT_EQ(runBandvox({"convert", "shape:torus", "-o", "t.vdb", "-r", "24"},
                         {.folder = mFolder.path()})
                  .status,
              0);
    expectFailure({"render", "t.vdb", "-o", "out.png", "--res", "200x200"}, 1, {"out.png"}, full);
    expectFailure({"render", "t.vdb", "-o", "out.exr", "--res", "200x200"}, 1, {"out.exr"}, full);
}

TEST_F(BadInput, DamagedVdb) {
    writeSeveralGrids(mFolder / "good.vdb");
    const std::string good = readText(mFolder / "good.vdb");
    writeText(mFolder / "cut.vdb", good.substr(0, good.size() / 2));
    expectFailure({"info", "cut.vdb"}, 3, {"cut.vdb"});
    expectFailure({"render", "cut.vdb", "-o", "out.png"}, 3, {"cut.vdb"});
    expectFailure({"info", "stdin.vdb"}, 3, {"standard input"});
    expectFailure({"info", "stdin.vdb"}, 3, {"standard input"},
                  {.standardInput = (mFolder / "cut.vdb").string()});
}

TEST_F(BadInput, VdbWithALengthThatIsAnyNumber) {
    writeSeveralGrids(mFolder / "good.vdb");
    const std::string good = readText(mFolder / "good.vdb") + std::string(100000, 'x');
    // In the place of each number that could be the length of a chunk of a voxel or two, the number
    // of bytes that are left, negative: so OpenVDB writes the length of a chunk that it has not
    // compressed.
    int refused = 0;
    for (std::size_t place = 0; place < good.size() - 100000; ++place) {
        std::int64_t length = 0;
        std::memcpy(&length, good.data() + place, sizeof length);
        if (length <= 16 || length > 40) continue;
        length = -static_cast<std::int64_t>(good.size() - place - 8);
        std::string bad = good;
        std::memcpy(bad.data() + place, &length, sizeof length);
        writeText(mFolder / "bad.vdb", bad);
        const RunResult result = runBandvox({"info", "bad.vdb"}, {.folder = mFolder.path()});
        EXPECT_TRUE(result.status == 0 || result.status == 3) << place << ": " << result.status;
        refused += result.status == 3 ? 1 : 0;
    }
    EXPECT_GE(refused, 3);
}

TEST_F(BadInput, GridThatIsNotThere) {
    writeSeveralGrids(mFolder / "several.vdb");
    expectFailure({"render", "several.vdb", "-o", "out.png", "--grid", "nose"}, 3,
                  {"'nose'", "'heat'", "'density'"});
    expectFailure({"render", "several.vdb", "-o", "out.png", "--grid", "vel"}, 3,
                  {"'vel'", "float"});
}

}  // namespace
}  // namespace bandvox::app_test
