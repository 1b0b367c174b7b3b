// What the convert command makes of points.

#include "run_command.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;

constexpr double kUnitBall = 4.0 / 3.0 * std::numbers::pi;

// Points evenly over a ball of radius 1, by the golden angle; `rest` is what follows in each line.
std::string ballPoints(int count, const std::string& rest, double sign = 1) {
    std::string text;
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count;
        const double r = std::sqrt(1 - z * z);
        const openvdb::Vec3d p(r * std::cos(i * turn), r * std::sin(i * turn), z);
        for (int axis = 0; axis < 3; ++axis) text += std::to_string(p[axis]) + " ";
        if (rest == "normal") {
            for (int axis = 0; axis < 3; ++axis) text += std::to_string(sign * p[axis]) + " ";
        } else {
            text += rest;
        }
        text += "\n";
    }
    return text;
}

class Points : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        writeText(*sFolder / "two.csv", "x,y,z,radius\n0,0,0,1\n3,0,0,0.5\n");
        writeText(*sFolder / "plain.xyz", "0 0 0\n3 0 0\n");
        writeText(*sFolder / "scan.xyz", ballPoints(2000, "normal"));
        writeText(*sFolder / "inward.xyz", ballPoints(2000, "normal", -1));
        writeText(*sFolder / "both.txt", "x y z nx ny nz radius\n0 0 0 0 0 1 1\n3 0 0 0 0 1 0.5\n");
        writeText(*sFolder / "points.ply",
                  "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                  "property float z\nproperty float pscale\nend_header\n0 0 0 1\n3 0 0 0.5\n");
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult convert(Names arguments) {
        arguments.insert(arguments.begin(), "convert");
        return runBandvox(arguments, {.folder = sFolder->path()});
    }

    static openvdb::FloatGrid::Ptr read(const std::string& name) {
        return openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(*sFolder / name).front());
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> Points::sFolder;

TEST_F(Points, WithRadiiAreBalls) {
    for (const char* input : {"two.csv", "points.ply", "both.txt"}) {
        const RunResult result =
            convert({input, "-o", "out.vdb", "-r", "60", "--stats", "stats.json"});
        ASSERT_EQ(result.status, 0) << result.err;
        const auto grid = read("out.vdb");
        EXPECT_NEAR(densityIntegral(*grid), 1.125 * kUnitBall, 1e-3 * kUnitBall);
        EXPECT_NEAR(grid->voxelSize()[0], 4.5 / 60, 1e-9);
        const auto metadata = densityMetadata(*grid);
        ASSERT_TRUE(metadata);
        EXPECT_EQ(metadata->source, input);
        EXPECT_EQ(metadata->route, "exact");
        EXPECT_LE(metadata->closureError, 1e-4);
        const auto at = [&](double x) {
            return grid->getConstAccessor().getValue(
                openvdb::Coord::round(grid->worldToIndex({x, 0, 0})));
        };
        EXPECT_NEAR(at(0), 1, 1e-3);
        EXPECT_NEAR(at(1), 0.5, 0.25);
        EXPECT_NEAR(at(1.8), 0, 1e-3);
        EXPECT_NEAR(at(3), 1, 1e-2);
        const auto stats = nlohmann::json::parse(readText(*sFolder / "stats.json"));
        EXPECT_EQ(stats["counts"]["points"], 2);
        EXPECT_EQ(stats["counts"]["balls_too_small"], 0);
    }
}

TEST_F(Points, TakeOneRadiusForAll) {
    ASSERT_EQ(
        convert({"plain.xyz", "-o", "out.vdb", "--radius", "0.5", "--voxel-size", "0.05"}).status,
        0);
    EXPECT_NEAR(densityIntegral(*read("out.vdb")), 0.25 * kUnitBall, 1e-3 * kUnitBall);
    const RunResult result =
        convert({"two.csv", "-o", "out.vdb", "--radius", "0.5", "--voxel-size", "0.05"});
    ASSERT_EQ(result.status, 0);
    EXPECT_NE(result.err.find("its own radii are not used"), std::string::npos) << result.err;
    EXPECT_NEAR(densityIntegral(*read("out.vdb")), 0.25 * kUnitBall, 1e-3 * kUnitBall);
}

TEST_F(Points, WithNormalsAreASurface) {
    ASSERT_EQ(convert({"scan.xyz", "-o", "out.vdb", "-r", "40", "--strict"}).status, 0);
    EXPECT_NEAR(densityIntegral(*read("out.vdb")), kUnitBall, 0.01 * kUnitBall);

    const RunResult inward = convert({"inward.xyz", "-o", "out.vdb", "-r", "40"});
    ASSERT_EQ(inward.status, 0) << inward.err;
    EXPECT_NE(inward.err.find("inward"), std::string::npos) << inward.err;
    EXPECT_NEAR(densityIntegral(*read("out.vdb")), kUnitBall, 0.01 * kUnitBall);
    EXPECT_EQ(convert({"inward.xyz", "-o", "no.vdb", "-r", "40", "--strict"}).status, 3);
    EXPECT_FALSE(std::filesystem::exists(*sFolder / "no.vdb"));
}

TEST_F(Points, BecomeMeshesLevelSetsAndLevels) {
    const RunResult mesh = convert(
        {"two.csv", "-o", "out.ply", "-r", "60", "--iso", "volume", "--stats", "stats.json"});
    ASSERT_EQ(mesh.status, 0) << mesh.err;
    const auto stats = nlohmann::json::parse(readText(*sFolder / "stats.json"));
    EXPECT_NEAR(stats["counts"]["mesh_volume"], 1.125 * kUnitBall, 1e-3 * kUnitBall);
    ASSERT_EQ(convert({"two.csv", "-o", "out.vdb", "-r", "60", "--as", "level-set"}).status, 0);
    EXPECT_EQ(read("out.vdb")->getGridClass(), openvdb::GRID_LEVEL_SET);
    ASSERT_EQ(convert({"two.csv", "-o", "out.vdb", "-r", "60", "--lod", "1", "--half"}).status, 0);
    EXPECT_EQ(readVdb(*sFolder / "out.vdb").size(), 2U);
    ASSERT_EQ(convert({"two.csv", "-o", "out.npy", "-r", "20"}).status, 0);
    EXPECT_TRUE(readText(*sFolder / "out.npy").starts_with("\x93NUMPY"));
}

TEST_F(Points, ComeInParts) {
    ASSERT_EQ(convert({"two.csv", "-o", "whole.vdb", "-r", "60"}).status, 0);
    double sum = 0;
    for (const char* part : {"1/2", "2/2"}) {
        const RunResult result =
            convert({"two.csv", "-o", "part.vdb", "-r", "60", "--shard", part});
        ASSERT_EQ(result.status, 0) << result.err;
        sum += densityIntegral(*read("part.vdb"));
    }
    EXPECT_NEAR(sum, densityIntegral(*read("whole.vdb")), 1e-6 * kUnitBall);
}

TEST_F(Points, WarnOfBallsThatAreTooSmall) {
    writeText(*sFolder / "dust.csv", "x,y,z,radius\n0,0,0,1\n3,0,0,0.001\n");
    const RunResult result = convert({"dust.csv", "-o", "out.vdb", "-r", "20"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("1 ball of 2"), std::string::npos) << result.err;
    EXPECT_EQ(convert({"dust.csv", "-o", "no.vdb", "-r", "20", "--strict"}).status, 4);
    EXPECT_EQ(convert({"plain.xyz", "-o", "no.vdb", "-r", "20", "--radius", "1e-3"}).status, 4);
}

TEST_F(Points, SayHowTheyWereMade) {
    ASSERT_EQ(convert({"two.csv", "-o", "made.vdb", "-r", "30", "--radius", "1"}).status, 0);
    const RunResult same =
        convert({"two.csv", "-o", "made.vdb", "-r", "30", "--radius", "1.0", "--skip-existing"});
    EXPECT_NE(same.err.find("skipped"), std::string::npos) << same.err;
    const RunResult other =
        convert({"two.csv", "-o", "made.vdb", "-r", "30", "--radius", "2", "--skip-existing"});
    EXPECT_NE(other.err.find("radius was 1, is 2"), std::string::npos) << other.err;
    ASSERT_EQ(convert({"plain.xyz", "-o", "liked.vdb", "--like", "made.vdb"}).status, 0);
    EXPECT_NE(runBandvox({"info", "liked.vdb"}, {.folder = sFolder->path()}).out.find("radius=2"),
              std::string::npos);
}

TEST_F(Points, AreConvertedFrameByFrame) {
    for (const char* number : {"1", "2"}) {
        writeText(*sFolder / ("p.000" + std::string(number) + ".csv"),
                  "x,y,z,radius\n0,0,0," + std::string(number) + "\n");
    }
    const RunResult result = convert({"p.####.csv", "-o", "p.####.vdb", "--voxel-size", "0.1"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NEAR(densityIntegral(*read("p.0002.vdb")), 8 * kUnitBall, 0.01 * kUnitBall);
}

TEST_F(Points, RefuseWhatMakesNoSense) {
    const auto expect = [&](int status, const Names& arguments, const std::string& word) {
        const RunResult result = convert(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(*sFolder / "no.vdb"));
    };
    writeText(*sFolder / "bad.csv", "x,y,z\n1,2,three\n");
    writeText(*sFolder / "one.csv", "x,y,z,radius\n1,2,3,0\n");
    expect(3, {"plain.xyz", "-o", "no.vdb"}, "--radius");
    expect(3, {"plain.xyz", "-o", "no.vdb", "--points", "surface"}, "normals");
    expect(3, {"scan.xyz", "-o", "no.vdb", "--points", "balls"}, "--radius");
    expect(3, {"missing.xyz", "-o", "no.vdb"}, "missing.xyz");
    expect(3, {"bad.csv", "-o", "no.vdb", "--radius", "1"}, "line 2");
    expect(3, {"one.csv", "-o", "no.vdb"}, "one place");
    expect(2, {"scan.xyz", "-o", "no.vdb", "--points", "surface", "--radius", "1"}, "--radius");
    expect(2, {"two.csv", "-o", "no.vdb", "--radius", "0"}, "--radius");
    expect(2, {"two.csv", "-o", "no.vdb", "--points", "cheese"}, "cheese");
    expect(2, {"two.csv", "-o", "no.vdb", "--threshold", "1"}, "--threshold");
    expect(2, {"two.csv", "-o", "no.vdb", "--route", "exact"}, "--route");
    expect(2, {"two.csv", "-o", "no.vdb", "--as", "values"}, "values");
    expect(2, {"shape:sphere", "-o", "no.vdb", "--radius", "1"}, "--radius");
}

}  // namespace
}  // namespace bandvox::app_test
