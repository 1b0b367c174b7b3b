// What the convert command makes of the solids that volumes stand for.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Names = std::vector<std::string>;
using openvdb::Vec3d;

// A .npy file of 16-bit numbers, [x][y][z].
void writeNpy(const std::filesystem::path& path, int side,
              const std::function<double(const Vec3d&)>& value) {
    std::string header = "{'descr': '<u2', 'fortran_order': False, 'shape': (";
    for (int axis = 0; axis < 3; ++axis) header += std::to_string(side) + ", ";
    header += "), }";
    header.append(118 - header.size() - 1, ' ');
    header += '\n';
    std::string text("\x93NUMPY\x01\x00", 8);
    text += static_cast<char>(header.size());
    text += '\0';
    text += header;
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < side; ++z) {
                const auto number = static_cast<std::uint16_t>(std::lround(value(Vec3d(x, y, z))));
                text += static_cast<char>(number & 0xFF);
                text += static_cast<char>(number >> 8);
            }
        }
    }
    writeText(path, text);
}

constexpr double kRadius = 18.3;
constexpr double kBallVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;

// Rises through 500 on a ball's surface, over some voxels.
double ballScan(const Vec3d& place) {
    const double depth = kRadius - (place - Vec3d(24.5, 23, 24.2)).length();
    return 500 + 100 * std::clamp(depth, -5.0, 5.0);
}

class SolidOfVolume : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        sFolder = std::make_unique<TemporaryFolder>();
        writeNpy(*sFolder / "ball.npy", 49, ballScan);
        auto levelSet = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
            1.0F, openvdb::Vec3f(0.5F, -2, 30), 0.05F);
        levelSet->setName("ball");
        writeVdb(*sFolder / "ball_sdf.vdb", {levelSet});
    }
    static void TearDownTestSuite() { sFolder.reset(); }

    static RunResult convert(Names arguments) {
        arguments.insert(arguments.begin(), "convert");
        return runBandvox(arguments, {.folder = sFolder->path()});
    }

    static openvdb::FloatGrid::Ptr read(const std::string& name, const std::string& grid) {
        for (const auto& found : readVdb(*sFolder / name)) {
            if (found->getName() == grid) return openvdb::gridPtrCast<openvdb::FloatGrid>(found);
        }
        return nullptr;
    }

    static std::unique_ptr<TemporaryFolder> sFolder;
};

std::unique_ptr<TemporaryFolder> SolidOfVolume::sFolder;

TEST_F(SolidOfVolume, OfAScanIsWhatIsAboveTheThreshold) {
    for (const char* factor : {"1", "2", "3.3"}) {
        const RunResult result = convert({"ball.npy", "-o", "bone.vdb", "--threshold", "500",
                                          "--factor", factor, "--stats", "stats.json"});
        ASSERT_EQ(result.status, 0) << result.err;
        const auto grid = read("bone.vdb", "density");
        ASSERT_TRUE(grid);
        EXPECT_NEAR(grid->voxelSize()[0], std::stod(factor), 1e-12);
        const auto metadata = densityMetadata(*grid);
        ASSERT_TRUE(metadata);
        EXPECT_EQ(metadata->route, "exact");
        EXPECT_EQ(metadata->source, "ball.npy");
        EXPECT_LE(metadata->closureError, 1e-4);
        EXPECT_NEAR(metadata->sourceVolume, kBallVolume, 2e-3 * kBallVolume);
        EXPECT_NEAR(densityIntegral(*grid), metadata->sourceVolume, 1e-3 * kBallVolume);
        Vec3d sum(0);
        for (auto value = grid->cbeginValueOn(); value; ++value) {
            double voxels = 1;
            Vec3d place = value.getCoord().asVec3d();
            if (!value.isVoxelValue()) {
                const openvdb::CoordBBox box = value.getBoundingBox();
                voxels = static_cast<double>(box.volume());
                place = 0.5 * (box.min().asVec3d() + box.max().asVec3d());
            }
            sum += voxels * *value * grid->indexToWorld(place);
        }
        const double voxel = std::stod(factor);
        sum *= voxel * voxel * voxel / densityIntegral(*grid);
        EXPECT_NEAR((sum - Vec3d(24.5, 23, 24.2)).length(), 0, 5e-3) << "where it lies";
        const auto stats = nlohmann::json::parse(readText(*sFolder / "stats.json"));
        EXPECT_EQ(stats["counts"]["source_volume"], metadata->sourceVolume);
    }
}

TEST_F(SolidOfVolume, TakesARangeOfValues) {
    const RunResult result = convert({"ball.npy", "-o", "shell.vdb", "--threshold", "300,800"});
    ASSERT_EQ(result.status, 0) << result.err;
    const double outer = kRadius + 2, inner = kRadius - 3;
    const double volume =
        4.0 / 3.0 * std::numbers::pi * (outer * outer * outer - inner * inner * inner);
    EXPECT_NEAR(densityMetadata(*read("shell.vdb", "density"))->sourceVolume, volume,
                2e-3 * volume);
}

TEST_F(SolidOfVolume, OfAScanBecomesAMeshOrALevelSet) {
    const RunResult mesh = convert({"ball.npy", "-o", "bone.ply", "--threshold", "500", "--iso",
                                    "volume", "--stats", "stats.json"});
    ASSERT_EQ(mesh.status, 0) << mesh.err;
    const auto stats = nlohmann::json::parse(readText(*sFolder / "stats.json"));
    EXPECT_NEAR(stats["counts"]["mesh_volume"], stats["counts"]["source_volume"],
                2e-5 * kBallVolume);

    ASSERT_EQ(convert({"ball.npy", "-o", "bone.vdb", "--threshold", "500", "--as", "level-set",
                       "--band", "4"})
                  .status,
              0);
    const auto grid = read("bone.vdb", "surface");
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_FLOAT_EQ(grid->background(), 4);
    // The filter moves the surface inward by 2 / r.
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const double distance =
            (value.getCoord().asVec3d() - Vec3d(24.5, 23, 24.2)).length() - kRadius;
        ASSERT_NEAR(*value, distance + 2 / kRadius, 0.05);
    }
}

TEST_F(SolidOfVolume, OfALevelSetKeepsItsPlaceOnEveryLattice) {
    for (const Names& lattice : {Names{}, Names{"--factor", "1.7"}, Names{"--voxel-size", "0.1"}}) {
        Names arguments{"ball_sdf.vdb", "-o", "out.vdb", "--as", "density"};
        arguments.insert(arguments.end(), lattice.begin(), lattice.end());
        const RunResult result = convert(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
        const auto grid = read("out.vdb", "density");
        ASSERT_TRUE(grid);
        EXPECT_NEAR(densityIntegral(*grid), 4.0 / 3.0 * std::numbers::pi, 0.01);
        const auto accessor = grid->getConstAccessor();
        const auto at = [&](const Vec3d& place) {
            return accessor.getValue(openvdb::Coord::round(grid->worldToIndex(place)));
        };
        EXPECT_NEAR(at({0.5, -2, 30}), 1, 1e-4);
        EXPECT_NEAR(at({0.5, -2, 31.7}), 0, 1e-4);
    }
}

TEST_F(SolidOfVolume, LevelSetsOnAnotherLatticeAreLevelSetsAgain) {
    const RunResult result = convert({"ball_sdf.vdb", "-o", "out.vdb", "--factor", "2"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto grid = read("out.vdb", "ball");
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_NEAR(grid->background(), 0.3, 1e-6);
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const double distance =
            (grid->indexToWorld(value.getCoord()) - Vec3d(0.5, -2, 30)).length() - 1;
        // A ball of 10 voxels loses 2 / 10 of one.
        ASSERT_NEAR(*value, distance + 0.1 * 0.2, 0.01);
    }
}

TEST_F(SolidOfVolume, LevelsOfDetailOfALevelSetAreLevelSets) {
    for (const Names& more : {Names{}, {"--factor", "1.5"}}) {
        Names arguments{"ball_sdf.vdb", "-o", "levels.vdb", "--lod", "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = convert(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
        const double side = more.empty() ? 0.05 : 0.075;
        for (const int level : {0, 1, 2}) {
            const std::string name = level == 0 ? "ball" : "ball_level_" + std::to_string(level);
            const auto grid = read("levels.vdb", name);
            ASSERT_TRUE(grid) << name;
            EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
            const double voxel = side * (1 << level);
            EXPECT_NEAR(grid->voxelSize()[0], voxel, 1e-8);
            for (auto value = grid->cbeginValueOn(); value; ++value) {
                const Vec3d place = grid->indexToWorld(value.getCoord());
                const double distance = (place - Vec3d(0.5, -2, 30)).length() - 1;
                // The filter, a Gaussian of variance 2 voxels², moves a ball's surface inward.
                const double shrunk = distance + 2 * voxel * voxel;
                ASSERT_NEAR(*value, shrunk, 0.2 * voxel + 0.01) << name;
            }
        }
    }
}

TEST_F(SolidOfVolume, TakesTheIsoValueOrSaysWhyNot) {
    ASSERT_EQ(convert({"shape:sphere", "-o", "sphere.vdb", "-r", "40"}).status, 0);
    const auto volumeOf = [&](const std::string& iso) {
        Names arguments{"sphere.vdb", "-o",      "distance.vdb", "--as",
                        "level-set",  "--stats", "iso.json",     "--iso"};
        arguments.push_back(iso);
        EXPECT_EQ(convert(arguments).status, 0);
        const auto stats = nlohmann::json::parse(readText(*sFolder / "iso.json"));
        return stats["counts"]["surface_volume"].get<double>();
    };
    EXPECT_GT(volumeOf("0.3"), 1.02 * volumeOf("0.7"));
    const double ball = densityMetadata(*read("sphere.vdb", "density"))->sourceVolume;
    EXPECT_NEAR(volumeOf("volume"), ball, 1e-4 * ball);

    // Values and distances have none that could be stored.
    for (const Names& arguments :
         {Names{"ball.npy", "-o", "no.vdb", "--iso", "0.4"},
          {"ball_sdf.vdb", "-o", "no.vdb", "--iso", "0.4"},
          {"ball_sdf.vdb", "-o", "no.vdb", "--factor", "2", "--iso", "volume"}}) {
        const RunResult result = convert(arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_NE(result.err.find("--iso"), std::string::npos) << result.err;
    }
}

TEST_F(SolidOfVolume, FilteredValuesAreNoDensityYet) {
    auto fog = openvdb::FloatGrid::create(0.0F);
    fog->setName("density");
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    fog->denseFill(openvdb::CoordBBox(0, 0, 0, 39, 39, 39), 8.0F);
    writeVdb(*sFolder / "fog.vdb", {fog});
    ASSERT_EQ(convert({"fog.vdb", "-o", "filtered.vdb", "--factor", "2"}).status, 0);
    ASSERT_EQ(densityMetadata(*read("filtered.vdb", "density"))->route, "filtered");
    const RunResult result = convert({"filtered.vdb", "-o", "solid.vdb", "--as", "density"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto solid = read("solid.vdb", "density");
    EXPECT_EQ(densityMetadata(*solid)->route, "exact");
    for (auto value = solid->cbeginValueOn(); value; ++value) ASSERT_LE(*value, 1.1F);

    const RunResult clamped = convert({"solid.vdb", "-o", "no.vdb", "--as", "density", "--clamp"});
    EXPECT_EQ(clamped.status, 2) << clamped.err;
    EXPECT_NE(clamped.err.find("--clamp"), std::string::npos) << clamped.err;
}

TEST_F(SolidOfVolume, KeepsTheUnit) {
    auto ball =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0F, openvdb::Vec3f(0), 0.1F);
    setPlaceMetadata(*ball, {"mm", "LPS"});
    writeVdb(*sFolder / "scan.vdb", {ball});
    for (const char* kind : {"density", "level-set", "fog"}) {
        const RunResult result =
            convert({"scan.vdb", "-o", "made.vdb", "--as", kind, "--factor", "1.5"});
        ASSERT_EQ(result.status, 0) << result.err;
        const auto place = placeMetadata(*readVdb(*sFolder / "made.vdb").front());
        EXPECT_EQ(place.unit, "mm") << kind;
        EXPECT_EQ(place.space, "LPS") << kind;
    }
}

TEST_F(SolidOfVolume, FogIsNothingOnTheSurface) {
    const RunResult result = convert({"shape:sphere", "-o", "fog.vdb", "--as", "fog", "-r", "40"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto fog = read("fog.vdb", "density");
    ASSERT_EQ(convert({"shape:sphere", "-o", "density.vdb", "-r", "40"}).status, 0);
    EXPECT_LT(densityIntegral(*fog), 0.9 * densityIntegral(*read("density.vdb", "density")));
    EXPECT_EQ(fog->getConstAccessor().getValue({0, 0, 0}), 1);
}

TEST_F(SolidOfVolume, RefusesWhatMakesNoSense) {
    const auto expect = [&](int status, const Names& arguments, const std::string& word) {
        const RunResult result = convert(arguments);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(*sFolder / "no.vdb"));
    };
    expect(2, {"ball.npy", "-o", "no.vdb", "--threshold", "much"}, "--threshold");
    expect(2, {"ball.npy", "-o", "no.vdb", "--threshold", "5,2"}, "lower");
    expect(2, {"ball.npy", "-o", "no.vdb", "--threshold", "1,2,3"}, "two");
    expect(2, {"ball.npy", "-o", "no.vdb", "--as", "density"}, "--threshold");
    expect(2, {"ball.npy", "-o", "no.vdb", "--threshold", "-5"}, "outside");
    expect(4, {"ball.npy", "-o", "no.vdb", "--threshold", "5000"}, "5000");
    expect(4, {"ball_sdf.vdb", "-o", "no.vdb", "--as", "density", "--threshold", "-9"}, "-9");
    expect(2, {"ball_sdf.vdb", "-o", "no.vdb", "--threshold", "0,1"}, "one number");
    expect(2, {"ball_sdf.vdb", "-o", "no.vdb", "--as", "values", "--threshold", "1"}, "values");
    expect(2, {"ball_sdf.vdb", "-o", "no.vdb", "--as", "cheese"}, "cheese");
    expect(2, {"ball_sdf.vdb", "-o", "no.vdb", "--as", "density", "--band", "4"}, "--band");
    expect(2, {"ball_sdf.vdb", "-o", "no.vdb", "--as", "fog", "--band", "0.2"}, "0.2");
    expect(2, {"ball_sdf.vdb", "-o", "no.vdb", "--as", "level-set", "--lod", "2"}, "--lod");
    expect(2, {"ball_sdf.vdb", "-o", "no.ply", "--as", "level-set"}, "mesh");
    expect(2, {"shape:sphere", "-o", "no.vdb", "--threshold", "1"}, "--threshold");
    expect(2, {"shape:sphere", "-o", "no.vdb", "--as", "values"}, "values");
    expect(2, {"shape:sphere", "-o", "no.vdb", "--band", "3"}, "--band");
}

}  // namespace
}  // namespace bandvox::app_test
