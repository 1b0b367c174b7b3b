// bandvox convert from and to arrays and stacks of images.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/array_box.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/array_source.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace bandvox::app_test {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Words = std::vector<std::string>;

// A .npy file of 12 × 9 × 10 values of 16 bits, the outer ones 0.
std::string sampleNpy() {
    std::string text = "{'descr': '<u2', 'fortran_order': False, 'shape': (12, 9, 10), }";
    while ((10 + text.size() + 1) % 64 != 0) text += ' ';
    text += '\n';
    std::string bytes = std::string("\x93NUMPY\x01\0", 8);
    bytes += static_cast<char>(text.size());
    bytes += '\0';
    bytes += text;
    for (int x = 0; x < 12; ++x) {
        for (int y = 0; y < 9; ++y) {
            for (int z = 0; z < 10; ++z) {
                const bool isInside = x > 1 && x < 10 && y > 0 && z > 2;
                const int value = isInside ? 5000 * x + 100 * y + 7 * z : 0;
                bytes += static_cast<char>(value & 255);
                bytes += static_cast<char>(value >> 8);
            }
        }
    }
    return bytes;
}

class ConvertStack : public testing::Test {
  protected:
    void SetUp() override { writeText(mFolder / "a.npy", sampleNpy()); }

    RunResult convert(Words words) const {
        words.insert(words.begin(), "convert");
        return runBandvox(words, {.folder = mFolder.path()});
    }

    void expectDone(const Words& words) const {
        const RunResult result = convert(words);
        EXPECT_EQ(result.status, 0) << testing::PrintToString(words) << result.err;
    }

    void expectFailure(const Words& words, int status, const Words& said) const {
        const RunResult result = convert(words);
        EXPECT_EQ(result.status, status) << testing::PrintToString(words) << result.err;
        for (const std::string& one : said) {
            EXPECT_NE(result.err.find(one), std::string::npos) << result.err << "  no " << one;
        }
    }

    // Values are the same, and of the type of a.npy.
    void expectSameAsSample(const std::string& name) const {
        expectDone({name, "-o", "again.npy", "--type", "uint16"});
        EXPECT_EQ(readText(mFolder / "again.npy"), sampleNpy()) << name;
    }

    TemporaryFolder mFolder;
};

TEST_F(ConvertStack, GoesRoundByAllFormats) {
    expectDone({"a.npy", "-o", "a.vdb"});
    expectSameAsSample("a.vdb");
    const Words outputs{"a.nrrd", "a.nhdr", "a.mha", "m.mhd", "s.###.tif", "s%04d.png", "a.tif"};
    for (const std::string& output : outputs) {
        expectDone({"a.vdb", "-o", output, "--type", "uint16"});
        expectSameAsSample(output);
        // From array to array without a grid in between, as it seems.
        expectDone({output, "-o", "b.nrrd", "--type", "uint16"});
        expectSameAsSample("b.nrrd");
        if (output == "s%04d.png") continue;
        for (const char* compression : {"zip", "none"}) {
            expectDone({"a.vdb", "-o", output, "--type", "uint16", "--compression", compression});
            expectSameAsSample(output);
        }
    }
    expectDone({"a.vdb", "-o", "f.###.exr"});
    expectSameAsSample("f.###.exr");
    // A folder of them.
    std::filesystem::create_directory(mFolder / "scan");
    expectDone({"a.vdb", "-o", "scan/x#.png"});
    expectSameAsSample("scan");
    expectSameAsSample("scan/");
    std::filesystem::remove(mFolder / "scan" / "x4.png");
    expectFailure({"scan", "-o", "no.vdb"}, 3, {"scan", "the number 4 is missing"});
    EXPECT_FALSE(std::filesystem::exists(mFolder / "no.vdb"));
}

TEST_F(ConvertStack, ReadsWhatNumPyReads) {
    expectDone({"a.npy", "-o", "a.vdb", "--spacing", "0.5,0.25,2"});
    expectDone({"a.vdb", "-o", "f.npy"});
    expectDone({"a.vdb", "-o", "h.npy", "--type", "half", "--box", "2,1,3,9,8,9"});
    expectDone({"a.vdb", "-o", "n.nrrd", "--type", "double"});
    if (runProgram({"/usr/bin/python3", "-c", "import numpy"}).status != 0) {
        GTEST_SKIP() << "there is no numpy";
    }
    const RunResult result =
        runProgram({"/usr/bin/python3", "-c",
                    "import numpy as np\n"
                    "a, f, h = (np.load(n + '.npy') for n in 'afh')\n"
                    "head, values = open('n.nrrd', 'rb').read().split(b'\\n\\n', 1)\n"
                    "n = np.frombuffer(values, '<f8').reshape(a.shape, order='F')\n"
                    "print(f.dtype, (f == a).all(), h.dtype, h.shape,\n"
                    "      (h == a[2:10, 1:9, 3:10].astype('f2')).all(), (n == a).all())\n"},
                   {.folder = mFolder.path()});
    EXPECT_EQ(result.out, "float32 True float16 (8, 8, 7) True True\n") << result.err;
    const std::string head = readText(mFolder / "n.nrrd").substr(0, 400);
    EXPECT_NE(head.find("space directions: (0.5,0,0) (0,0.25,0) (0,0,2)\n"), std::string::npos);
    EXPECT_NE(head.find("sizes: 12 9 10\n"), std::string::npos) << head;
}

TEST_F(ConvertStack, PlacesArrays) {
    expectDone({"a.npy", "-o", "a.vdb", "--spacing", "0.1", "--origin", "1,2,3"});
    auto grid = readVdb(mFolder / "a.vdb").front();
    EXPECT_LT((grid->indexToWorld(Coord(1, 2, 3)) - openvdb::Vec3d(1.1, 2.2, 3.3)).length(), 1e-9);
    EXPECT_EQ(arrayBox(*grid), CoordBBox(0, 0, 0, 11, 8, 9));
    // On another lattice the array's box means nothing.
    expectDone({"a.npy", "-o", "half.vdb", "--factor", "2"});
    grid = readVdb(mFolder / "half.vdb").front();
    EXPECT_EQ(arrayBox(*grid), grid->evalActiveVoxelBoundingBox());
    const RunResult said = convert({"a.npy", "-o", "a.vdb"});
    EXPECT_NE(said.err.find("nothing says how large"), std::string::npos) << said.err;
    expectFailure({"a.npy", "-o", "no.vdb", "--spacing", "1,2"}, 2, {"--spacing"});
    expectFailure({"a.npy", "-o", "no.vdb", "--spacing", "0"}, 2, {"--spacing"});
    expectFailure({"a.npy", "-o", "no.vdb", "--origin", "1"}, 2, {"--origin"});
    expectFailure({"a.npy", "-o", "no.vdb", "--channel", "R"}, 2, {"channel"});
    expectFailure({"shape:torus", "-o", "no.vdb", "--spacing", "1"}, 2, {"--spacing"});
    expectFailure({"a.vdb", "-o", "no.vdb", "--series", "1"}, 2, {"--series"});
}

TEST_F(ConvertStack, WritesDensitiesOfSolids) {
    writeText(mFolder / "cube.obj", cubeObj());
    for (const char* input : {"cube.obj", "shape:cube"}) {
        expectDone({input, "-o", "cube.###.png", "-r", "20", "--stats", "s.json"});
        const auto counts = nlohmann::json::parse(readText(mFolder / "s.json"))["counts"];
        EXPECT_EQ(counts["clipped_voxels"], 0);
        const auto source = openArray(mFolder / "cube.###.png");
        const ArrayInfo& info = source->info();
        EXPECT_EQ(counts["array_voxels"], std::int64_t(info.slices()) * info.valuesPerSlice());
        std::vector<float> values(static_cast<std::size_t>(info.valuesPerSlice()) *
                                  static_cast<std::size_t>(info.slices()));
        source->readSlices(values);
        const int middle = (info.slices() / 2 * info.size.y() + info.size.y() / 2) * info.size.x() +
                           info.size.x() / 2;
        EXPECT_NEAR(values[static_cast<std::size_t>(middle)], 65535, 10);
        EXPECT_NEAR(values.front(), 0, 10);
        std::filesystem::remove(mFolder / "cube.000.png");
    }
    expectDone({"shape:cube", "-o", "cube.vdb", "-r", "20"});
    expectDone({"cube.vdb", "-o", "cube.npy", "--type", "uint8", "--range", "0,0.5"});
    const RunResult clipped =
        convert({"cube.vdb", "-o", "cube.npy", "--type", "uint8", "--range", "0,0.5"});
    EXPECT_NE(clipped.err.find("clipped"), std::string::npos) << clipped.err;
    expectFailure({"cube.vdb", "-o", "no.npy", "--type", "uint8", "--range", "0,0.5", "--strict"},
                  4, {"--strict"});
    expectFailure({"cube.vdb", "-o", "no.#.png", "--range", "0,0.5", "--strict"}, 4, {"--strict"});
    EXPECT_FALSE(std::filesystem::exists(mFolder / "no.npy"));
    EXPECT_FALSE(std::filesystem::exists(mFolder / "no.0.png"));
}

TEST_F(ConvertStack, SaysWhatRoundingLoses) {
    // A density of somebody else: nothing says that 0 to 1 is its range.
    auto grid = openvdb::FloatGrid::create(0.0F);
    for (int x = 0; x < 10; ++x) grid->tree().setValueOn(Coord(x, 0, 0), 0.1F * float(x) + 0.05F);
    grid->setName("smoke");
    writeVdb(mFolder / "smoke.vdb", openvdb::GridCPtrVec{grid});
    const RunResult result = convert({"smoke.vdb", "-o", "smoke.#.png"});
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.err.find("--range 0,1"), std::string::npos) << result.err;
    const RunResult spread = convert({"smoke.vdb", "-o", "smoke.#.png", "--range", "0,1"});
    EXPECT_EQ(spread.err.find("warning"), std::string::npos) << spread.err;
}

TEST_F(ConvertStack, WritesToStreams) {
    expectDone({"a.npy", "-o", "a.vdb"});
    for (const std::string extension : {".npy", ".nrrd"}) {
        writeText(mFolder / ("out" + extension), "");
        const RunResult result = runBandvox(
            {"convert", "a.vdb", "-o", "stdout" + extension, "--type", "uint16"},
            {.folder = mFolder.path(), .standardOutput = (mFolder / ("out" + extension)).string()});
        EXPECT_EQ(result.status, 0) << result.err;
        expectSameAsSample("out" + extension);
    }
}

TEST_F(ConvertStack, GoesWithSolidsFramesAndStamps) {
    expectDone({"a.npy", "-o", "s.##.png"});
    // What of a stack is above a threshold, as an array.
    expectDone({"s.##.png", "-o", "solid.nrrd", "--threshold", "15000", "--spacing", "0.5",
                "--type", "uint8"});
    const auto solid = openArray(mFolder / "solid.nrrd");
    EXPECT_NEAR(solid->info().toWorld(0, 0), 0.5, 1e-9);
    std::vector<float> values(static_cast<std::size_t>(solid->info().valuesPerSlice()) *
                              static_cast<std::size_t>(solid->info().slices()));
    solid->readSlices(values);
    // Seven voxels wide, it is not quite 1 in its midst.
    EXPECT_GE(*std::max_element(values.begin(), values.end()), 230);
    EXPECT_LE(*std::min_element(values.begin(), values.end()), 3);
    // A stack's numbers are no frames, those of volumes are.
    expectDone({"a.npy", "-o", "f.1.vdb"});
    expectDone({"a.npy", "-o", "f.2.vdb"});
    expectDone({"f.#.vdb", "-o", "f.#.tif", "--type", "uint16"});
    expectSameAsSample("f.1.tif");
    expectSameAsSample("f.2.tif");
    // A volume made of a stack knows of every slice.
    expectDone({"s.##.png", "-o", "s.vdb", "--skip-existing"});
    const RunResult again = convert({"s.##.png", "-o", "s.vdb", "--skip-existing"});
    EXPECT_NE(again.err.find("skipped"), std::string::npos) << again.err;
    expectDone({"s.##.png", "-o", "s.vdb", "--skip-existing", "--spacing", "2"});
    EXPECT_NEAR(readVdb(mFolder / "s.vdb").front()->voxelSize().x(), 2, 1e-9);
    expectFailure({"s.vdb", "-o", "s.nrrd", "--skip-existing"}, 2, {"--skip-existing", "s.nrrd"});
}

TEST_F(ConvertStack, SparesWhatItReads) {
    expectDone({"a.npy", "-o", "a.nhdr", "--type", "uint16"});
    expectFailure({"a.nhdr", "-o", "a.mhd"}, 2, {"a.raw", "another file"});
    expectSameAsSample("a.nhdr");
    std::filesystem::create_directory(mFolder / "scan");
    expectDone({"a.npy", "-o", "scan/x.##.png"});
    expectFailure({"scan", "-o", "scan/y.##.png"}, 2, {"where the slices of INPUT are"});
    expectFailure({"scan/x.##.png", "-o", "scan/x.%02d.png"}, 2, {"INPUT"});
    expectSameAsSample("scan");
}

TEST_F(ConvertStack, AFullDiskLeavesTheOldSlices) {
    for (const char* pattern : {"s.##.png", "s.##.tif", "s.##.exr"}) {
        ASSERT_EQ(convert({"shape:sphere", "-o", pattern, "-r", "40"}).status, 0);
        const std::string first = std::string("s.20") + std::string(pattern).substr(4);
        const std::string before = readText(mFolder / first);
        ASSERT_GT(before.size(), 500U);
        const RunResult full = runBandvox({"convert", "shape:cube", "-o", pattern, "-r", "40"},
                                          {.folder = mFolder.path(), .largestFile = 200});
        EXPECT_EQ(full.status, 1) << full.err;
        EXPECT_EQ(readText(mFolder / first), before) << pattern;
    }
}

TEST_F(ConvertStack, RefusesVoxelsThatTransformsCannotHold) {
    ASSERT_EQ(convert({"a.npy", "-o", "a.vdb"}).status, 0);
    for (const Words& words : {Words{"a.npy", "-o", "no.vdb", "--spacing", "1e-6"},
                               {"a.npy", "-o", "no.vdb", "--spacing", "1e-6", "--threshold", "9"},
                               {"a.vdb", "-o", "no.vdb", "--voxel-size", "1e-6"}}) {
        const RunResult result = convert(words);
        EXPECT_EQ(result.status, words[0] == "a.vdb" ? 2 : 3) << result.err;
        EXPECT_NE(result.err.find("no less than 1.44e-05"), std::string::npos) << result.err;
    }
}

TEST_F(ConvertStack, KnowsTheSpacesOfScans) {
    const std::string head =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 6 6 6\nspace directions: (1,0,0) (0,1,0) "
        "(0,0,2)\nspace origin: (10,20,30)\nencoding: raw\n";
    const std::string values(6 * 6 * 6, '\7');
    writeText(mFolder / "ras.nrrd", head + "space: RAS\n\n" + values);
    writeText(mFolder / "lps.nrrd", head + "space: left-posterior-superior\n\n" + values);
    writeText(mFolder / "none.nrrd", head + "space dimension: 3\n\n" + values);
    const auto placeOf = [&](const std::string& file) {
        const auto grid = readVdb(mFolder / file).front();
        return grid->indexToWorld(Coord(1, 2, 3));
    };
    for (const char* name : {"ras", "lps", "none"}) {
        expectDone({std::string(name) + ".nrrd", "-o", std::string(name) + ".vdb"});
    }
    EXPECT_EQ(placeOf("ras.vdb"), openvdb::Vec3d(11, 22, 36));
    // From a scan, a grid, and on the way to a solid, a mesh and another scan.
    expectDone({"ras.nrrd", "-o", "turned.vdb", "--space", "LPS"});
    EXPECT_EQ(placeOf("turned.vdb"), openvdb::Vec3d(-11, -22, 36));
    expectDone({"ras.vdb", "-o", "turned.vdb", "--space", "LPS"});
    EXPECT_EQ(placeOf("turned.vdb"), openvdb::Vec3d(-11, -22, 36));
    expectDone({"ras.vdb", "-o", "turned.vdb", "--space", "LPS", "--factor", "2"});
    EXPECT_EQ(placeOf("turned.vdb"), openvdb::Vec3d(-12, -24, 42));
    expectDone({"ras.vdb", "-o", "solid.vdb", "--space", "LPS", "--threshold", "3"});
    const auto solid = readVdb(mFolder / "solid.vdb").front();
    const auto box = solid->evalActiveVoxelBoundingBox();
    EXPECT_LT((solid->indexToWorld(box.getCenter()) - openvdb::Vec3d(-12.5, -22.5, 35)).length(),
              1);
    expectDone({"ras.vdb", "-o", "solid.ply", "--space", "LPS", "--iso", "3"});
    expectDone({"ras.vdb", "-o", "turned.mha"});
    expectDone({"turned.mha", "-o", "back.vdb", "--space", "RAS"});
    EXPECT_EQ(placeOf("back.vdb"), placeOf("ras.vdb"));

    // Two spaces are not mixed; what says none goes with both.
    const Words said{"left-posterior-superior", "right-anterior-superior"};
    expectFailure({"ras.vdb", "-o", "no.vdb", "--onto", "lps.vdb"}, 3, said);
    expectDone({"ras.vdb", "-o", "onto.vdb", "--onto", "none.vdb"});
    for (const Words& words : {Words{"merge", "ras.vdb", "lps.vdb", "-o", "no.vdb"},
                               {"compare", "ras.vdb", "lps.vdb", "--only", "values"}}) {
        const RunResult result = runBandvox(words, {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 3) << result.err;
        for (const std::string& one : said) {
            EXPECT_NE(result.err.find(one), std::string::npos) << result.err;
        }
    }
    const RunResult same = runBandvox({"compare", "ras.vdb", "back.vdb", "--only", "values"},
                                      {.folder = mFolder.path()});
    EXPECT_EQ(same.status, 0) << same.err;
    expectFailure({"none.vdb", "-o", "no.vdb", "--space", "LPS"}, 2, {"does not say"});
    expectFailure({"none.nrrd", "-o", "no.vdb", "--space", "LPS"}, 2, {"does not say"});
    expectFailure({"shape:ball", "-o", "no.vdb", "--space", "LPS"}, 2, {"--space"});
    EXPECT_FALSE(std::filesystem::exists(mFolder / "no.vdb"));
}

TEST_F(ConvertStack, RefusesWhatDoesNotGoTogether) {
    expectDone({"a.npy", "-o", "a.vdb"});
    const std::vector<std::pair<Words, Words>> cases{
        {{"-o", "x.png"}, {"x.png", "slice.####.tif"}},
        {{"-o", "x.#.png", "--type", "float"}, {"uint8, uint16"}},
        {{"-o", "x.#.exr", "--type", "uint8"}, {"half, float"}},
        {{"-o", "x.nrrd", "--type", "half"}, {"NRRD", "half"}},
        {{"-o", "x.npy", "--type", "int"}, {"--type", "uint8"}},
        {{"-o", "x.npy", "--range", "0,1"}, {"whole numbers"}},
        {{"-o", "x.npy", "--range", "1,0", "--type", "uint8"}, {"--range"}},
        {{"-o", "x.npy", "--box", "0,0,0"}, {"--box"}},
        {{"-o", "x.npy", "--box", "5,0,0,4,9,9"}, {"--box"}},
        {{"-o", "x.npy", "--compression", "zip"}, {".npy"}},
        {{"-o", "x.nrrd", "--compression", "blosc"}, {"--compression"}},
        {{"-o", "x.npy", "--half"}, {"--half"}},
        {{"-o", "x.npy", "--lod", "1"}, {"--lod"}},
        {{"-o", "x.vdb", "--type", "uint8"}, {"--type"}},
        {{"-o", "x.vdb", "--box", "0,0,0,1,1,1"}, {"--box"}}};
    for (const auto& [options, said] : cases) {
        Words words{"a.vdb"};
        words.insert(words.end(), options.begin(), options.end());
        expectFailure(words, 2, said);
    }
    expectFailure({"a.vdb", "-o", "none/x.#.png", "--type", "uint8"}, 1, {"no folder"});
    expectFailure({"a.vdb", "-o", "x.npy", "--grid", "none"}, 3, {"none"});
    expectFailure({"none.#.png", "-o", "x.vdb"}, 3, {"none.#.png"});
    EXPECT_EQ(mFolder.contents(), (Words{"a.npy", "a.vdb"}));
}

}  // namespace
}  // namespace bandvox::app_test
