// What the fit command makes of tables, and which it refuses.

#include "run_command.h"

#include <bandvox/grid/density_grid.h>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

double heightAt(double x, double y) {
    return 1 + 0.3 * std::sin(3 * x) * std::cos(2 * y);
}

std::string tableOfHeights() {
    std::ostringstream text;
    text.precision(17);
    text << "x,y,height,r,g,b\n";
    for (int i = 0; i < 300; ++i) {
        const double x = std::fmod(i * 0.754877666246693, 1.0);
        const double y = std::fmod(i * 0.569840290998053, 1.0);
        text << x << "," << y << "," << heightAt(x, y) << "," << x << "," << y << ",0.5\n";
    }
    return text.str();
}

class Fit : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        writeText(*sFolder / "heights.csv", tableOfHeights());
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult fit(Names arguments) {
        arguments.insert(arguments.begin(), "fit");
        return runBandvox(std::move(arguments), {.folder = sFolder->path()});
    }

    /// Runs a fit of a table that cannot be used; nothing may be written.
    static void expectRefused(const std::string& name, const std::string& text,
                              const std::string& words, int status = 3, Names more = {}) {
        const TemporaryFolder folder;
        writeText(folder / name, text);
        Names arguments{"fit", name, "-o", "out.bpt"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = runBandvox(arguments, {.folder = folder.path()});
        EXPECT_EQ(result.status, status) << text.substr(0, 60);
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(folder.contents(), Names{name});
    }

    static std::string read(const std::string& name) {
        std::ifstream stream(*sFolder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> Fit::sFolder;

TEST_F(Fit, WritesSamplesThatAreTheFunction) {
    const RunResult result = fit({"heights.csv", "-o", "heights.npy", "--samples", "41",
                                  "--rectangle", "0,0,1,1", "--stats", "stats.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string bytes = read("heights.npy");
    ASSERT_EQ(bytes.size(), 128 + 41 * 41 * 4 * sizeof(double));
    EXPECT_NE(bytes.find("(41, 41, 4)"), std::string::npos);
    for (std::size_t i = 4; i < 37; ++i) {
        for (std::size_t j = 4; j < 37; ++j) {
            std::array<double, 4> values{};
            std::memcpy(values.data(), bytes.data() + 128 + (i * 41 + j) * sizeof(values),
                        sizeof(values));
            const double x = static_cast<double>(i) / 40;
            const double y = static_cast<double>(j) / 40;
            EXPECT_NEAR(values[0], heightAt(x, y), 1e-3);
            EXPECT_NEAR(values[1], x, 1e-3);
            EXPECT_NEAR(values[2], y, 1e-3);
        }
    }
    const auto stats = nlohmann::json::parse(read("stats.json"));
    EXPECT_EQ(stats["counts"]["points"], 300);
    EXPECT_LE(stats["counts"]["levels"].back()["largest"], 1e-12);
}

TEST_F(Fit, WritesPatchesMeshesAndPictures) {
    ASSERT_EQ(
        fit({"heights.csv", "-o", "surface.bpt", "--max-level", "3", "--tolerance", "0.1"}).status,
        0);
    std::istringstream patches(read("surface.bpt"));
    int count = 0;
    patches >> count;
    EXPECT_GE(count, 4);
    double number = 0;
    int numbers = 0;
    while (patches >> number) ++numbers;
    EXPECT_EQ(numbers, count * (2 + 16 * 3));

    for (const std::string name : {"surface.obj", "surface.ply", "surface.glb"}) {
        EXPECT_EQ(fit({"heights.csv", "-o", name, "--samples", "20"}).status, 0) << name;
    }
    // A point, and its colours, sRGB.
    EXPECT_NE(read("surface.obj").find("\nv "), std::string::npos);
    const RunResult picture = fit({"heights.csv", "-o", "surface.exr", "--samples", "33"});
    EXPECT_EQ(picture.status, 0) << picture.err;
    EXPECT_GT(read("surface.exr").size(), 1000U);
}

TEST_F(Fit, WritesTheSolidUnderTheSurface) {
    const RunResult result = fit(
        {"heights.csv", "-o", "solid.vdb", "-r", "40", "--base", "0", "--rectangle", "0,0,1,1"});
    ASSERT_EQ(result.status, 0) << result.err;
    openvdb::initialize();
    const auto grids = readVdb(*sFolder / "solid.vdb");
    ASSERT_EQ(grids.size(), 2U);
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
    // The integral of the function over the square.
    const double volume = 1 + 0.3 * (1 - std::cos(3.0)) / 3 * std::sin(2.0) / 2;
    EXPECT_NEAR(densityIntegral(*density), volume, 1e-4);
    EXPECT_LE(densityMetadata(*density)->closureError, 1e-4);
}

TEST_F(Fit, LeavesDetailAway) {
    ASSERT_EQ(fit({"heights.csv", "-o", "coarse.bpt", "--levels", "1..2"}).status, 0);
    EXPECT_EQ(read("coarse.bpt").substr(0, 3), "16\n");
    EXPECT_EQ(fit({"heights.csv", "-o", "none.bpt", "--levels", "30..31"}).status, 2);
    EXPECT_EQ(fit({"heights.csv", "-o", "none.bpt", "--levels", "3..2"}).status, 2);
    const RunResult beyond = fit({"heights.csv", "-o", "none.bpt", "--levels", "1..99"});
    EXPECT_EQ(beyond.status, 2);
    EXPECT_NE(beyond.err.find("--levels is 1..99"), std::string::npos) << beyond.err;
}

TEST_F(Fit, WarnsOfASurfaceThatGoesFarBeyondItsValues) {
    writeText(*sFolder / "cliff.csv", tableOfHeights() + "0.5,0.5,1,0,0,0\n0.50001,0.5,2,0,0,0\n");
    const RunResult warned = fit({"cliff.csv", "-o", "cliff.npy", "--samples", "5"});
    EXPECT_EQ(warned.status, 0) << warned.err;
    EXPECT_NE(warned.err.find("warning: the surface: it goes beyond the values"), std::string::npos)
        << warned.err;
    EXPECT_EQ(fit({"cliff.csv", "-o", "no.npy", "--samples", "5", "--strict"}).status, 4);
    const RunResult smooth = fit({"heights.csv", "-o", "smooth.npy", "--samples", "5", "--strict"});
    EXPECT_EQ(smooth.status, 0) << smooth.err;
}

TEST_F(Fit, SaysIfTheToleranceIsNotReached) {
    const RunResult result =
        fit({"heights.csv", "-o", "not.bpt", "--max-level", "1", "--tolerance", "1e-9"});
    EXPECT_EQ(result.status, 4);
    EXPECT_NE(result.err.find("--tolerance"), std::string::npos) << result.err;
    EXPECT_EQ(fit({"heights.csv", "-o", "warned.bpt", "--max-level", "1"}).status, 0);
    EXPECT_EQ(fit({"heights.csv", "-o", "not.bpt", "--max-level", "1", "--strict"}).status, 4);
}

TEST_F(Fit, TakesColumnsByNameAndNumber) {
    writeText(*sFolder / "mixed.txt", "time;lat;lon;depth\n9;0;0;1\n9;1;0;2\n9;0;1;3\n9;1;1;5\n");
    EXPECT_EQ(fit({"mixed.txt", "-o", "mixed.bpt", "--columns", "lon,lat,depth"}).status, 0);
    EXPECT_EQ(fit({"mixed.txt", "-o", "mixed.bpt", "--columns", "2,3,4"}).status, 0);
    const RunResult unknown = fit({"mixed.txt", "-o", "mixed.bpt", "--columns", "lon,lat,high"});
    EXPECT_EQ(unknown.status, 2);
    EXPECT_NE(unknown.err.find("'high'"), std::string::npos) << unknown.err;
}

TEST_F(Fit, RefusesBadTables) {
    expectRefused("t.csv", "x,y,z\n0,0,1\n1,zero,2\n0,1,3\n", "line 3 has \"zero\"");
    expectRefused("t.csv", "0,0,1\n1,0\n0,1,3\n", "line 2 has 2 columns");
    expectRefused("t.csv", "0,0,1\n1,0,nan\n0,1,3\n", "line 2 has nan as value");
    expectRefused("t.csv", "0,0,1\n1,0,1e999\n0,1,3\n", "line 2 has inf as value");
    expectRefused("t.csv", "1 2 3\n", "all at (1, 2)");
    expectRefused("t.xyz", "1 2 3\n1 2 3\n1 2 3\n", "all at (1, 2)");
    expectRefused("t.csv", "", "no points");
    expectRefused("t.csv", "1,2\n3,4\n", "2 columns");
    expectRefused("t.csv", "0,0,1\n1,0,2\n0,1,3\n1,0,9\n",
                  "(1, 0) has values from 2 (line 2) to 9 (line 4)");
    expectRefused("t.csv", "0,0,1\n1,0,2\n0,2,3\n", "(line 3) is outside the rectangle", 3,
                  {"--rectangle", "0,0,1,1"});
    // A first line with a number is one of numbers, if with a slip.
    expectRefused("t.csv", "0,0,1o\n1,0,2\n0,1,3\n", "line 1 has \"1o\"");
    expectRefused("t.csv", "x,y\n", "2 columns");
    expectRefused("t.csv", "0,0,1\n1,0,2\n0,2,3\n", "--rectangle", 2, {"--rectangle", "0,0,0,1"});
    expectRefused("t.foo", "0,0,1\n", "unknown kind");
    expectRefused("t.npy", "not an array", "no .npy file");
    std::string announced("\x93NUMPY\x01\x00\x76\x00", 10);
    announced += "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000, 3), }";
    announced.resize(128, ' ');
    expectRefused("t.npy", announced + std::string(240, '\0'), "announces 1000000000 rows");
}

TEST_F(Fit, CarriesColorsThroughToTheSolid) {
    const RunResult result = fit({"heights.csv", "-o", "colored.vdb", "-r", "40"});
    ASSERT_EQ(result.status, 0) << result.err;
    openvdb::initialize();
    const auto grids = readVdb(*sFolder / "colored.vdb");
    ASSERT_EQ(grids.size(), 2U);
    const auto colors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[1]);
    ASSERT_TRUE(colors);
    EXPECT_EQ(colors->getName(), "Cd");
    // Around the surface the colour is (x, y, 0.5).
    const openvdb::Vec3d place(0.4, 0.6, heightAt(0.4, 0.6));
    const auto voxel = openvdb::Coord::round(colors->worldToIndex(place));
    auto at = colors->getConstAccessor();
    ASSERT_TRUE(at.isValueOn(voxel));
    EXPECT_NEAR(at.getValue(voxel)[0], 0.4, 0.03);
    EXPECT_NEAR(at.getValue(voxel)[1], 0.6, 0.03);
    EXPECT_NEAR(at.getValue(voxel)[2], 0.5, 0.01);
    ASSERT_EQ(fit({"heights.csv", "-o", "colored.ply", "--samples", "9"}).status, 0);
    EXPECT_NE(read("colored.ply").find("property uchar red"), std::string::npos);
}

TEST_F(Fit, SaysIfTheNoiseIsNotReached) {
    EXPECT_NE(fit({"heights.csv", "-o", "s.bpt", "--smooth", "5"}).err.find("by --smooth"),
              std::string::npos);
    EXPECT_EQ(fit({"heights.csv", "-o", "s.bpt", "--smooth", "5", "--strict"}).status, 4);
}

TEST_F(Fit, HintsAtNoise) {
    std::string noisy;
    for (int i = 0; i < 400; ++i) {
        const double x = std::fmod(i * 0.754877666246693, 1.0);
        const double y = std::fmod(i * 0.569840290998053, 1.0);
        noisy += std::to_string(x) + "," + std::to_string(y) + "," +
                 std::to_string(std::fmod(i * 0.618033988749895, 1.0)) + "\n";
    }
    writeText(*sFolder / "noisy.csv", noisy);
    const RunResult result = fit({"noisy.csv", "-o", "noisy.bpt"});
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.err.find("need --smooth"), std::string::npos) << result.err;
    EXPECT_EQ(fit({"heights.csv", "-o", "h.bpt"}).err.find("need --smooth"), std::string::npos);
}

std::string cloudOfPoints() {
    std::ostringstream text;
    text.precision(17);
    text << "x,y,z,temperature,r,g,b,vel.x,vel.y,vel.z\n";
    for (int i = 0; i < 400; ++i) {
        const double x = std::fmod(i * 0.819172513396164, 1.0);
        const double y = std::fmod(i * 0.671043606703789, 1.0);
        const double z = std::fmod(i * 0.549700477901970, 1.0);
        text << x << "," << y << "," << z << "," << heightAt(x, y) + z << "," << x << "," << y
             << "," << z << "," << -y << "," << x << ",0\n";
    }
    return text.str();
}

TEST_F(Fit, MakesGridsOfPlacesInSpace) {
    writeText(*sFolder / "cloud.csv", cloudOfPoints());
    const RunResult result =
        fit({"cloud.csv", "--volume", "-o", "field.vdb", "-r", "20", "--stats", "stats.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    openvdb::initialize();
    const auto grids = readVdb(*sFolder / "field.vdb");
    ASSERT_EQ(grids.size(), 3U);
    const auto scalars = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
    const auto colors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[1]);
    const auto speeds = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grids[2]);
    ASSERT_TRUE(scalars && colors && speeds);
    EXPECT_EQ(scalars->getName(), "temperature");
    EXPECT_EQ(colors->getName(), "Cd");
    EXPECT_EQ(colors->getVectorType(), openvdb::VEC_INVARIANT);
    EXPECT_EQ(speeds->getName(), "vel");
    EXPECT_EQ(speeds->getVectorType(), openvdb::VEC_CONTRAVARIANT_RELATIVE);
    const openvdb::Coord voxel(10, 8, 12);
    const openvdb::Vec3d place = scalars->indexToWorld(voxel);
    EXPECT_NEAR(scalars->tree().getValue(voxel), heightAt(place[0], place[1]) + place[2], 5e-3);
    EXPECT_NEAR(colors->tree().getValue(voxel)[1], place[1], 5e-3);
    EXPECT_NEAR(speeds->tree().getValue(voxel)[0], -place[1], 5e-3);
    EXPECT_FALSE(scalars->tree().isValueOn(openvdb::Coord(200, 0, 0)));
    const auto stats = nlohmann::json::parse(read("stats.json"));
    EXPECT_EQ(stats["counts"]["points"], 400);
    EXPECT_LE(stats["counts"]["largest"], 1e-12);
}

TEST_F(Fit, TakesSomeColumnsOfPlacesInSpace) {
    writeText(*sFolder / "cloud.csv", cloudOfPoints());
    const RunResult one =
        fit({"cloud.csv", "--volume", "--columns", "x,y,z,temperature", "-o", "one.vdb",
             "--voxel-size", "0.1", "--reach", "0.3", "--smooth", "0.01", "--half"});
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_NE(one.err.find("within 0.3 of the points"), std::string::npos) << one.err;
    EXPECT_EQ(fit({"cloud.csv", "--volume", "-o", "one.ply"}).status, 2);
    EXPECT_EQ(fit({"cloud.csv", "--volume", "-o", "one.vdb", "--base", "0"}).status, 2);
    EXPECT_EQ(fit({"heights.csv", "-o", "one.vdb", "--reach", "1"}).status, 2);
    EXPECT_EQ(fit({"cloud.csv", "--volume", "-o", "one.vdb", "--reach", "100"}).status, 2);
}

TEST_F(Fit, RefusesBadTablesOfPlacesInSpace) {
    const auto refuse = [](const std::string& text, const std::string& words) {
        const TemporaryFolder folder;
        writeText(folder / "t.csv", text);
        const RunResult result =
            runBandvox({"fit", "t.csv", "--volume", "-o", "out.vdb"}, {.folder = folder.path()});
        EXPECT_EQ(result.status, 3) << text;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(folder.contents(), Names{"t.csv"});
    };
    refuse("0,0,1\n1,0,2\n", "3 columns; expected 4 at least: x, y, z and a value");
    refuse("x,y,z,t\n0,0,0,1\n1,0,0,hot\n", "line 3 has \"hot\" in column 4, t");
    refuse("0,0,0,1\n1,0,0,2\n1,0,0,3\n", "(1, 0, 0) has values from 2 (line 2) to 3 (line 3)");
    refuse("1,2,3,4\n", "two places at least");
    refuse("1,2,3,4\n1,2,inf,4\n", "line 2 has inf as z");
}

TEST_F(Fit, ReadsArraysOfNumpy) {
    std::string bytes("\x93NUMPY\x01\x00\x76\x00", 10);
    bytes += "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }";
    bytes.resize(128, ' ');
    for (const double number : {0.0, 0.0, 1.0, 1.0, 0.0, 2.0, 0.0, 1.0, 3.0, 1.0, 1.0, 5.0}) {
        bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
    }
    writeText(*sFolder / "four.npy", bytes);
    const RunResult result = fit({"four.npy", "-o", "four.bpt"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("4 points"), std::string::npos) << result.err;
}

TEST_F(Fit, WritesDerivativesNormalsAndCurvature) {
    ASSERT_EQ(fit({"heights.csv", "-o", "what.npy", "--samples", "9", "--columns", "x,y,height",
                   "--quantities", "value,normal,mean"})
                  .status,
              0);
    const std::string bytes = read("what.npy");
    EXPECT_NE(bytes.find("(9, 9, 5)"), std::string::npos);
    ASSERT_EQ(bytes.size(), 128 + 9 * 9 * 5 * sizeof(double));
    std::array<double, 5> middle{};
    std::memcpy(middle.data(), bytes.data() + 128 + (4 * 9 + 4) * sizeof(middle), sizeof(middle));
    EXPECT_NEAR(middle[1] * middle[1] + middle[2] * middle[2] + middle[3] * middle[3], 1, 1e-12);
    EXPECT_GT(middle[3], 0);

    ASSERT_EQ(
        fit({"heights.csv", "-o", "what.exr", "--samples", "16", "--quantities", "gaussian,dx"})
            .status,
        0);
    const auto picture = OIIO::ImageInput::open((*sFolder / "what.exr").string());
    ASSERT_TRUE(picture);
    const auto& names = picture->spec().channelnames;
    for (const char* name : {"gaussian", "dx", "Z", "N.X"}) {
        EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
    }
    const RunResult unknown = fit({"heights.csv", "-o", "x.npy", "--quantities", "value,torsion"});
    EXPECT_EQ(unknown.status, 2);
    EXPECT_NE(unknown.err.find("gaussian, mean"), std::string::npos) << unknown.err;
    EXPECT_EQ(fit({"heights.csv", "-o", "x.npy", "--quantities", "mean,mean"}).status, 2);
    EXPECT_EQ(fit({"heights.csv", "-o", "x.obj", "--quantities", "mean"}).status, 2);
}

TEST_F(Fit, WritesGradientsOfPlacesInSpace) {
    openvdb::initialize();
    writeText(*sFolder / "cloud.csv", cloudOfPoints());
    ASSERT_EQ(
        fit({"cloud.csv", "--volume", "-o", "slopes.vdb", "-r", "20", "--quantities", "gradient"})
            .status,
        0);
    const auto grids = readVdb(*sFolder / "slopes.vdb");
    ASSERT_FALSE(grids.empty());
    for (const auto& grid : grids) {
        EXPECT_TRUE(grid->getName().ends_with("_gradient")) << grid->getName();
        EXPECT_TRUE(grid->isType<openvdb::Vec3SGrid>());
    }
    EXPECT_EQ(fit({"cloud.csv", "--volume", "-o", "x.vdb", "--quantities", "mean"}).status, 2);
}

TEST_F(Fit, WritesNoMoreThanAMillionPatchesUnasked) {
    // Bumps that take what nets leave need cells far smaller than the distance of points.
    constexpr std::size_t kPoints = 100'000;
    std::string bytes("\x93NUMPY\x01\x00\x76\x00", 10);
    bytes += "{'descr': '<f8', 'fortran_order': False, 'shape': (100000, 3), }";
    bytes.resize(128, ' ');
    std::mt19937 generator(1);
    for (std::size_t i = 0; i < kPoints; ++i) {
        const double x = generator() / 4294967296.0;
        const double y = generator() / 4294967296.0;
        for (const double number : {x, y, heightAt(x, y)}) {
            bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
        }
    }
    writeText(*sFolder / "many.npy", bytes);
    const RunResult result = fit({"many.npy", "-o", "many.bpt"});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("000 at most, unless --max-level is given"), std::string::npos)
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(*sFolder / "many.bpt"));
    EXPECT_EQ(fit({"many.npy", "-o", "many.bpt", "--levels", "1..5"}).status, 0);
}

TEST_F(Fit, IsTheSameForAnyNumberOfThreads) {
    ASSERT_EQ(fit({"heights.csv", "-o", "one.npy", "--threads", "1"}).status, 0);
    ASSERT_EQ(fit({"heights.csv", "-o", "three.npy", "--threads", "3"}).status, 0);
    EXPECT_EQ(read("one.npy"), read("three.npy"));
}

}  // namespace
}  // namespace bandvox::app_test
