// Files of every format, broken in ways that come from a seed: each is refused, or gives a result.
// scripts/test-broken-files does the same with many more.

#include "run_command.h"
#include "sample_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <regex>

namespace bandvox::app_test {
namespace {

using Dice = std::mt19937;

/// A file that is whole.
struct Sample {
    std::string name;
    std::string content;
};

/// A number from 0 up to `end`, which counts as 1 if it is less.
std::size_t below(std::size_t end, Dice& dice) {
    return dice() % std::max<std::size_t>(end, 1);
}

/// A place, half of the time where a file's description is.
std::size_t placeIn(const std::string& content, Dice& dice) {
    constexpr std::size_t kHead = 2048;
    const bool anywhere = dice() % 2 == 0;
    return below(anywhere ? content.size() : std::min(content.size(), kHead), dice);
}

std::string cutShort(std::string content, Dice& dice) {
    content.resize(placeIn(content, dice));
    return content;
}

std::string withBitFlipped(std::string content, Dice& dice) {
    const std::size_t place = placeIn(content, dice);
    content[place] = static_cast<char>(content[place] ^ (1 << dice() % 8));
    return content;
}

std::string withBytesChanged(std::string content, Dice& dice) {
    for (int i = 0; i < 8; ++i) content[placeIn(content, dice)] = static_cast<char>(dice() % 256);
    return content;
}

/// Four bytes, or eight, become a count that is far too large, or none.
std::string withCountBlownUp(std::string content, Dice& dice) {
    static const std::array<std::string, 5> kCounts{
        std::string(4, '\0'), std::string(4, '\xff'), std::string(8, '\xff'),
        std::string("\xff\xff\xff\x7f", 4), std::string("\0\0\0\x80", 4)};
    const std::string& count = kCounts[below(kCounts.size(), dice)];
    const std::size_t place = placeIn(content, dice);
    return content.substr(0, place) + count +
           content.substr(std::min(place + count.size(), content.size()));
}

/// A number in a text becomes one that cannot be.
std::string withNumberBlownUp(std::string content, Dice& dice) {
    static const std::array<const char*, 10> kNumbers{"0",
                                                      "-1",
                                                      "2147483648",
                                                      "9223372036854775808",
                                                      "99999999999999999999999",
                                                      "nan",
                                                      "inf",
                                                      "1e308",
                                                      "1e-320",
                                                      ""};
    static const std::regex number(R"(-?\d+(\.\d+)?)");
    constexpr std::ptrdiff_t kHead = 4096;
    const auto end = content.begin() +
                     std::min<std::ptrdiff_t>(kHead, static_cast<std::ptrdiff_t>(content.size()));
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::sregex_iterator i(content.begin(), end, number), none; i != none; ++i) {
        found.emplace_back(i->position(), i->length());
    }
    if (found.empty()) return withCountBlownUp(content, dice);
    const auto [place, length] = found[below(found.size(), dice)];
    return content.replace(place, length, kNumbers[below(kNumbers.size(), dice)]);
}

std::string withPartDoubled(std::string content, Dice& dice) {
    const auto [low, high] = std::minmax({placeIn(content, dice), placeIn(content, dice)});
    return content.insert(high, content.substr(low, high - low));
}

std::string withPartsExchanged(std::string content, Dice& dice) {
    const auto [low, high] = std::minmax({placeIn(content, dice), placeIn(content, dice)});
    return content.substr(0, low) + content.substr(high) + content.substr(low, high - low);
}

constexpr std::array kWays{cutShort,          withBitFlipped,  withBytesChanged,  withCountBlownUp,
                           withNumberBlownUp, withPartDoubled, withPartsExchanged};

class BrokenFiles : public testing::Test {
  protected:
    /// A volume or an array that the command makes of a shape.
    Sample made(const std::string& name, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"convert", "shape:torus", "-o", name, "-r", "8", "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = runBandvox(arguments, {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 0) << result.err;
        std::string content = readText(mFolder / name);
        std::filesystem::remove(mFolder / name);
        return {name, std::move(content)};
    }

    /// Expects that a file of that content is refused, or gives a result: of convert, or of what
    /// else is asked for.
    void expectAnswer(const std::string& name, const std::string& content,
                      std::vector<std::string> arguments = {}) {
        writeText(mFolder / name, content);
        if (arguments.empty()) arguments = {"convert", name, "-r", "8"};
        arguments.insert(arguments.end(), {"-o", "out.vdb", "-q"});
        const RunResult result = runBandvox(arguments, {.folder = mFolder.path()});
        EXPECT_TRUE(result.status == 0 || result.status == 3 || result.status == 4)
            << result.status << ": " << result.err;
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), result.status == 0 ? 0 : 1)
            << result.err;
        if (result.status == 3) {
            EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
        }
#ifndef BANDVOX_SANITIZED
        EXPECT_LT(result.peakBytes, 1'000'000'000);
#endif
        std::vector<std::string> expected = mWhole;
        expected.push_back(name);
        if (result.status == 0) expected.emplace_back("out.vdb");
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(mFolder.contents(), expected);
        std::filesystem::remove(mFolder / "out.vdb");
        std::filesystem::remove(mFolder / name);
    }

    /// Breaks each of them in all ways.
    void expectAnswers(const std::vector<Sample>& samples) {
        Dice dice(1);
        for (const Sample& sample : samples) {
            for (std::size_t way = 0; way < kWays.size(); ++way) {
                SCOPED_TRACE(sample.name + ", way " + std::to_string(way));
                expectAnswer(sample.name, kWays[way](sample.content, dice));
            }
        }
    }

    TemporaryFolder mFolder;
    std::vector<std::string> mWhole;  ///< other files in it
};

TEST_F(BrokenFiles, Meshes) {
    expectAnswers({{"cube.obj", cubeObj()},
                   {"ascii.ply", cubePly()},
                   {"ascii.stl", cubeStlAscii()},
                   {"binary.stl", cubeStlBinary()},
                   {"cube.glb", cubeGlb()},
                   {"binary.fbx", exportedCube("fbx")},
                   {"text.fbx", exportedCube("fbxa")},
                   {"cube.dae", exportedCube("collada")}});
}

TEST_F(BrokenFiles, Volumes) {
    expectAnswers({made("blosc.vdb"), made("zip.vdb", {"--compression", "zip"}),
                   made("none.vdb", {"--compression", "none"}), made("half.vdb", {"--half"})});
}

TEST_F(BrokenFiles, Arrays) {
    expectAnswers({made("array.npy"), made("array.nrrd"), made("array.mha"),
                   made("pages.tif", {"--type", "uint16"})});
}

TEST_F(BrokenFiles, Points) {
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n";
    for (const char* name : {"x", "y", "z", "radius"}) {
        ply += std::string("property float ") + name + "\n";
    }
    ply += "end_header\n";
    constexpr std::array<float, 12> kBalls{0, 0, 0, 1, 1.5, 0, 0, 0.5, 0, 1.5, 0, 0.25};
    ply.append(reinterpret_cast<const char*>(kBalls.data()), sizeof kBalls);
    expectAnswers({{"balls.csv", "x,y,z,radius\n0,0,0,1\n1.5,0,0,0.5\n0,1.5,0,0.25\n"},
                   {"balls.xyz", "0 0 0 1\n1.5 0 0 0.5\n# far\n0 1.5 0 0.25\n"},
                   {"balls.ply", ply}});
}

TEST_F(BrokenFiles, OneOfTwo) {
    const Sample whole = made("whole.vdb"), broken = made("broken.vdb", {"--half"});
    writeText(mFolder / whole.name, whole.content);
    mWhole = {whole.name};
    Dice dice(2);
    for (const auto& way : kWays) {
        const std::string content = way(broken.content, dice);
        expectAnswer(broken.name, content, {"merge", whole.name, broken.name});
        expectAnswer(broken.name, content, {"merge", broken.name, whole.name, "--resample"});
    }
}

TEST_F(BrokenFiles, ContentOfAnotherFormat) {
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.gltf", "a.glb", "a.dae",
                             "a.fbx", "a.vdb", "a.npy", "a.nrrd", "a.mha", "a.tif", "a.dcm"}) {
        SCOPED_TRACE(name);
        const bool isText = std::string(name) == "a.ply";
        expectAnswer(name, isText ? cubeObj() : cubePly());
    }
}

TEST_F(BrokenFiles, StatementBeforeTheFirstMaterial) {
    // The importer would put it into a material that is not there.
    const std::string obj = "mtllib a.mtl\n" + cubeObj();
    for (const std::string& start :
         {std::string("map_Kd a.png\n"), std::string("aniso 0.5\n"),
          std::string("# red\nbump a.png\nnewmtl red\n"),
          std::string("newmtl\0", 7).substr(1) + "\rdisp a.png\n", std::string("a\0norm b", 8)}) {
        SCOPED_TRACE(start);
        writeText(mFolder / "a.mtl", start);
        writeText(mFolder / "a.obj", obj);
        const RunResult result = runBandvox({"convert", "a.obj", "-o", "out.vdb", "-r", "8"},
                                            {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 3) << result.err;
        EXPECT_NE(result.err.find("a.mtl"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("newmtl"), std::string::npos) << result.err;
    }
}

TEST_F(BrokenFiles, MaterialsThatAreNoRegularFile) {
    std::filesystem::create_directory(mFolder / "folder.mtl");
    for (const std::string name : {"/dev/zero", "folder.mtl", "a.obj"}) {
        writeText(mFolder / "a.obj", "mtllib " + name + "\n" + cubeObj());
        const RunResult result = runBandvox({"convert", "a.obj", "-o", "out.vdb", "-r", "8"},
                                            {.folder = mFolder.path()});
        EXPECT_EQ(result.status, 3) << name << ": " << result.err;
    }
}

}  // namespace
}  // namespace bandvox::app_test
