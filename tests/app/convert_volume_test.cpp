// What the convert command makes of .vdb files.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;
using openvdb::Coord;

class ConvertVolume : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        writeText(*sFolder / "cube.obj", coloredCubeObj());
        for (const Names& made : {Names{"cube.obj", "-o", "cube.vdb", "-r", "40", "--color"},
                                  Names{"cube.obj", "-o", "coarse.vdb", "-r", "20"}}) {
            const RunResult result = convert(made);
            ASSERT_EQ(result.status, 0) << result.err;
        }
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult convert(Names arguments) {
        arguments.insert(arguments.begin(), "convert");
        return runBandvox(arguments, {.folder = sFolder->path()});
    }

    static openvdb::GridPtrVec read(const std::string& name) { return readVdb(*sFolder / name); }

    static openvdb::FloatGrid::Ptr density(const std::string& name) {
        for (const auto& grid : read(name)) {
            if (grid->getName() == "density") return openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        }
        return nullptr;
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> ConvertVolume::sFolder;

double largestDifference(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    double largest = 0;
    auto other = b.getConstAccessor();
    for (auto it = a.cbeginValueOn(); it; ++it) {
        largest = std::max<double>(largest, std::abs(*it - other.getValue(it.getCoord())));
    }
    return largest;
}

TEST_F(ConvertVolume, MakesOfADensityWhatTheMeshWouldBecome) {
    const auto expected = density("coarse.vdb");
    for (const Names& lattice :
         {Names{"--factor", "2"}, Names{"--voxel-size", "0.1"}, Names{"--onto", "coarse.vdb"}}) {
        Names arguments{"cube.vdb", "-o", "half.vdb", "--stats", "half.json"};
        arguments.insert(arguments.end(), lattice.begin(), lattice.end());
        const RunResult result = convert(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
        const auto found = density("half.vdb");
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->voxelSize().x(), 0.1, 1e-12);
        EXPECT_LE(largestDifference(*found, *expected), 3e-4);
        EXPECT_LE(largestDifference(*expected, *found), 3e-4);
        const auto metadata = densityMetadata(*found);
        ASSERT_TRUE(metadata);
        EXPECT_NEAR(metadata->gridVolume, 8, 8e-4);
        EXPECT_EQ(metadata->source, "cube.obj");

        // The colours come along: red below, blue above.
        ASSERT_EQ(read("half.vdb").size(), 2U);
        const auto colors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(read("half.vdb")[1]);
        ASSERT_TRUE(colors);
        EXPECT_EQ(colors->getName(), "Cd");
        const auto top = colors->tree().getValue(Coord(0, 0, 10));
        const auto bottom = colors->tree().getValue(Coord(0, 0, -10));
        EXPECT_NEAR(top[2], 1, 0.02);
        EXPECT_NEAR(top[0], 0, 0.02);
        EXPECT_NEAR(bottom[0], 1, 0.02);
        std::ifstream stats(*sFolder / "half.json");
        EXPECT_EQ(nlohmann::json::parse(stats)["counts"]["grids"], 2);
    }
}

TEST_F(ConvertVolume, WritesLevelsOfDetailOfVolumesAndMeshes) {
    for (const char* input : {"cube.vdb", "cube.obj"}) {
        const RunResult result =
            convert({input, "-o", "levels.vdb", "-r", "40", "--lod", "2", "--grid", "density"});
        if (std::string(input) == "cube.obj") {
            EXPECT_EQ(result.status, 2) << "--grid is for volumes";
        }
        const Names plain =
            std::string(input) == "cube.vdb"
                ? Names{input, "-o", "levels.vdb", "--lod", "2", "--grid", "density"}
                : Names{input, "-o", "levels.vdb", "--lod", "2", "-r", "40"};
        ASSERT_EQ(convert(plain).status, 0);
        const auto grids = read("levels.vdb");
        ASSERT_EQ(grids.size(), 3U);
        EXPECT_EQ(grids[0]->getName(), "density");
        EXPECT_EQ(grids[1]->getName(), "density_level_1");
        EXPECT_EQ(grids[2]->getName(), "density_level_2");
        EXPECT_NEAR(grids[2]->voxelSize().x(), 0.2, 1e-12);
        const auto level = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[1]);
        EXPECT_LE(largestDifference(*level, *density("coarse.vdb")), 3e-4);
    }
}

TEST_F(ConvertVolume, CopiesWhatNeedsNoFilter) {
    ASSERT_EQ(convert({"cube.vdb", "-o", "copy.vdb", "--compression", "zip"}).status, 0);
    EXPECT_EQ(largestDifference(*density("copy.vdb"), *density("cube.vdb")), 0);
    ASSERT_EQ(convert({"cube.vdb", "-o", "half16.vdb", "--half", "--iso", "0.4"}).status, 0);
    const auto metadata = densityMetadata(*density("half16.vdb"));
    EXPECT_GT(metadata->storageError, 0);
    EXPECT_EQ(metadata->iso, 0.4);
    EXPECT_LE(largestDifference(*density("half16.vdb"), *density("cube.vdb")),
              metadata->storageError);

    // From stream to stream.
    writeText(*sFolder / "piped.vdb", "");
    const RunResult piped =
        runBandvox({"convert", "stdin.vdb", "-o", "stdout.vdb", "--factor", "2"},
                   {.folder = sFolder->path(),
                    .standardInput = (*sFolder / "cube.vdb").string(),
                    .standardOutput = (*sFolder / "piped.vdb").string()});
    ASSERT_EQ(piped.status, 0) << piped.err;
    EXPECT_LE(largestDifference(*density("piped.vdb"), *density("coarse.vdb")), 3e-4);
}

TEST_F(ConvertVolume, TakesGridsOfOtherKinds) {
    auto mask = openvdb::BoolGrid::create(false);
    mask->setName("mask");
    mask->fill(openvdb::CoordBBox(Coord(-20), Coord(20)), true);
    auto doubles = openvdb::DoubleGrid::create(0);
    doubles->setName("heat");
    doubles->fill(openvdb::CoordBBox(Coord(-20), Coord(20)), 300);
    auto steps = openvdb::Vec3IGrid::create();
    steps->setName("steps");
    steps->tree().setValue(Coord(1), openvdb::Vec3i(1, 2, 3));
    writeVdb(*sFolder / "kinds.vdb", openvdb::GridCPtrVec{mask, doubles, steps});
    const RunResult result = convert({"kinds.vdb", "-o", "out.vdb", "--factor", "3"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("'steps' of type vec3i was left away"), std::string::npos)
        << result.err;
    const auto grids = read("out.vdb");
    ASSERT_EQ(grids.size(), 2U);
    const auto first = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0]);
    const auto second = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[1]);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->getName(), "mask");
    EXPECT_NEAR(first->tree().getValue(Coord(0)), 1, 1e-3);
    EXPECT_NEAR(second->tree().getValue(Coord(0)), 300, 0.3);
    EXPECT_NEAR(second->tree().getValue(Coord(7, 0, 0)), 300 * 0.41, 15) << "half a voxel outside";
    EXPECT_EQ(convert({"kinds.vdb", "-o", "out.vdb", "--factor", "3", "--strict"}).status, 4);
}

TEST_F(ConvertVolume, ColoursHaveLevelsOfDetailToo) {
    ASSERT_EQ(convert({"cube.vdb", "-o", "levels.vdb", "--lod", "2"}).status, 0);
    std::vector<std::string> names;
    for (const auto& grid : read("levels.vdb")) names.push_back(grid->getName());
    EXPECT_EQ(names, (std::vector<std::string>{"density", "density_level_1", "density_level_2",
                                               "Cd", "Cd_level_1", "Cd_level_2"}));
    const auto coarse = openvdb::gridPtrCast<openvdb::Vec3SGrid>(read("levels.vdb")[5]);
    ASSERT_TRUE(coarse);
    EXPECT_NEAR(coarse->voxelSize()[0], 4 * density("cube.vdb")->voxelSize()[0], 1e-12);
    const double top = coarse->worldToIndex({0, 0, 1})[2];
    EXPECT_NEAR(coarse->tree().getValue(Coord(0, 0, static_cast<int>(std::round(top))))[2], 1,
                0.02);
}

// A level set's surface is 0: the work of rebuilding it is not to be for nothing.
TEST_F(ConvertVolume, RefusesAnIsoOfLevelSetsAtOnce) {
    ASSERT_EQ(convert({"cube.vdb", "-o", "distances.vdb", "--as", "level-set"}).status, 0);
    const RunResult result =
        convert({"distances.vdb", "-o", "no.vdb", "--factor", "2", "--iso", "volume"});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("--as level-set"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("resample"), std::string::npos) << result.err;
    EXPECT_EQ(convert({"distances.vdb", "-o", "half.vdb", "--factor", "2", "--iso", "volume",
                       "--as", "level-set"})
                  .status,
              0);
}

TEST_F(ConvertVolume, TakesArrays) {
    // A ball in a MetaImage, 40 values a side of 0.5 mm.
    std::string values;
    for (int i = 0; i < 40 * 40 * 40; ++i) {
        const openvdb::Vec3d at(i % 40 - 20, i / 40 % 40 - 20, i / 1600 - 20);
        values += at.length() < 15 ? '\x64' : '\0';
    }
    writeText(*sFolder / "ball.mha",
              "NDims = 3\nDimSize = 40 40 40\nElementType = MET_UCHAR\nElementSpacing = 0.5 0.5 "
              "0.5\nOffset = 10 0 0\nAnatomicalOrientation = LPS\nElementDataFile = LOCAL\n" +
                  values);
    const RunResult result = convert({"ball.mha", "-o", "ball.vdb"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("40 x 40 x 40 values of type uint8, axes left-posterior-superior"),
              std::string::npos)
        << result.err;
    const auto ball = density("ball.vdb");
    EXPECT_EQ(ball->tree().getValue(Coord(20)), 100);
    EXPECT_EQ(ball->tree().getValue(Coord(0)), 0);
    EXPECT_EQ(ball->indexToWorld(Coord(20)), openvdb::Vec3d(20, 10, 10));
    ASSERT_EQ(convert({"ball.mha", "-o", "half.vdb", "--factor", "2"}).status, 0);
    EXPECT_NEAR(densityIntegral(*density("half.vdb")), densityIntegral(*ball),
                1e-3 * densityIntegral(*ball));
    // What is all background is nothing.
    EXPECT_EQ(convert({"ball.mha", "-o", "no.vdb", "--background", "100"}).status, 0);
    EXPECT_EQ(density("no.vdb")->tree().getValue(Coord(20)), 100);
    EXPECT_EQ(density("no.vdb")->tree().getValue(Coord(0)), 0);
    EXPECT_EQ(convert({"ball.mha", "-o", "x.vdb", "--grid", "density"}).status, 2);
    EXPECT_EQ(convert({"cube.vdb", "-o", "x.vdb", "--background", "1"}).status, 2);
    EXPECT_EQ(convert({"none.npy", "-o", "x.vdb"}).status, 3);
    std::filesystem::remove(*sFolder / "no.vdb");
}

TEST_F(ConvertVolume, RefusesWhatDoesNotGoTogether) {
    const std::vector<std::pair<Names, std::string>> cases{
        {{"--factor", "2", "--voxel-size", "1"}, "got 2"},
        {{"--factor", "0"}, "--factor"},
        {{"--no-filter"}, "another lattice"},
        {{"--no-filter", "--factor", "2", "--order", "4"}, "exclude"},
        {{"--route", "exact"}, "--route"},
        {{"--clamp"}, "--clamp"},
        {{"--lod", "17"}, "--lod"}};
    for (const auto& [options, said] : cases) {
        Names arguments{"cube.vdb", "-o", "no.vdb"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const RunResult result = convert(arguments);
        EXPECT_EQ(result.status, 2) << said;
        EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
    }
    EXPECT_EQ(convert({"cube.vdb", "-o", "no.vdb", "--grid", "smoke"}).status, 3);
    EXPECT_EQ(convert({"cube.vdb", "-o", "no.vdb", "--onto", "none.vdb"}).status, 3);
    EXPECT_EQ(convert({"none.vdb", "-o", "no.vdb"}).status, 3);
    EXPECT_EQ(convert({"cube.vdb", "-o", "cube.vdb", "--factor", "2"}).status, 2);
    EXPECT_EQ(convert({"cube.obj", "-o", "no.vdb", "--factor", "2"}).status, 2);
    writeVdb(*sFolder / "empty.vdb", openvdb::GridCPtrVec{openvdb::FloatGrid::create(0.0F)});
    EXPECT_EQ(convert({"empty.vdb", "-o", "no.vdb"}).status, 4);
    EXPECT_FALSE(std::filesystem::exists(*sFolder / "no.vdb"));
}

}  // namespace
}  // namespace bandvox::app_test
