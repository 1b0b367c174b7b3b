// The colours that convert writes beside a density.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

namespace bandvox::app_test {
namespace {

using Json = nlohmann::json;

openvdb::Vec3SGrid::Ptr readColors(const std::filesystem::path& path) {
    for (const auto& grid : readVdb(path)) {
        if (grid->getName() == "Cd") return openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid);
    }
    return nullptr;
}

TEST(ConvertColor, WritesColorsBesideTheDensity) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", coloredCubeObj());
    const RunOptions here{.folder = folder.path()};
    const RunResult result = runBandvox(
        {"convert", "cube.obj", "-o", "c.vdb", "-r", "32", "--color", "--stats", "s.json"}, here);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "color    "), 1) << result.err;
    const openvdb::GridPtrVec grids = readVdb(folder / "c.vdb");
    ASSERT_EQ(grids.size(), 2u);
    EXPECT_EQ(grids[0]->getName(), "density");
    const auto colors = readColors(folder / "c.vdb");
    ASSERT_TRUE(colors);
    EXPECT_EQ(colors->transform(), grids[0]->transform());
    EXPECT_EQ(colors->getVectorType(), openvdb::VEC_INVARIANT);
    EXPECT_EQ(sourceOf(*colors), "cube.obj");
    // The lower face lies at index -16, the upper one at 16.
    const openvdb::Vec3f below = colors->tree().getValue({0, 0, -16});
    EXPECT_NEAR(below[0], 1, 1e-3);
    EXPECT_NEAR(below[2], 0, 1e-3);
    EXPECT_NEAR(colors->tree().getValue({0, 0, 16})[2], 1, 1e-3);
    EXPECT_NEAR(colors->tree().getValue({16, 0, 0})[0], 0.5, 1e-3);
    EXPECT_FALSE(colors->tree().isValueOn({0, 0, 0}));
    const Json counts = Json::parse(readText(folder / "s.json")).at("counts");
    EXPECT_EQ(counts.at("colored_triangles"), 12);
    EXPECT_EQ(counts.at("color_voxels"), colors->activeVoxelCount());
    EXPECT_GT(counts.at("color_samples").get<int>(), 0);
}

TEST(ConvertColor, ChangesNothingOfTheDensity) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", coloredCubeObj());
    const RunOptions here{.folder = folder.path()};
    for (const char* route : {"exact", "auto", "winding"}) {
        for (const bool color : {false, true}) {
            std::vector<std::string> arguments{
                "convert", "cube.obj", "-o",      color ? "with.vdb" : "without.vdb",
                "-r",      "16",       "--route", route};
            if (color) arguments.emplace_back("--color");
            ASSERT_EQ(runBandvox(arguments, here).status, 0) << route;
        }
        const openvdb::GridPtrVec with = readVdb(folder / "with.vdb");
        const openvdb::GridPtrVec without = readVdb(folder / "without.vdb");
        ASSERT_EQ(with.size(), 2u);
        ASSERT_EQ(without.size(), 1u);
        const auto a = openvdb::gridPtrCast<openvdb::FloatGrid>(with[0]);
        const auto b = openvdb::gridPtrCast<openvdb::FloatGrid>(without[0]);
        EXPECT_TRUE(a->tree().hasSameTopology(b->tree()));
        EXPECT_EQ(densityIntegral(*a), densityIntegral(*b)) << route;
    }
}

TEST(ConvertColor, KeepsColorsInSixteenBits) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", coloredCubeObj());
    const RunOptions here{.folder = folder.path()};
    for (const char* name : {"whole.vdb", "half.vdb"}) {
        std::vector<std::string> arguments{"convert", "cube.obj", "-o",     name,
                                           "-r",      "16",       "--color"};
        if (std::string(name) == "half.vdb") arguments.emplace_back("--half");
        ASSERT_EQ(runBandvox(arguments, here).status, 0);
    }
    const auto whole = readColors(folder / "whole.vdb");
    const auto half = readColors(folder / "half.vdb");
    EXPECT_TRUE(half->saveFloatAsHalf());
    const auto accessor = half->getConstAccessor();
    for (auto value = whole->cbeginValueOn(); value; ++value) {
        ASSERT_LE((*value - accessor.getValue(value.getCoord())).length(), 5e-4);
    }
}

TEST(ConvertColor, InfoTellsOfTheColors) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", coloredCubeObj());
    const RunOptions here{.folder = folder.path()};
    ASSERT_EQ(
        runBandvox({"convert", "cube.obj", "-o", "c.vdb", "-r", "16", "--color"}, here).status, 0);
    const RunResult result = runBandvox({"info", "c.vdb", "--json"}, here);
    ASSERT_EQ(result.status, 0) << result.err;
    const Json grid = Json::parse(result.out).at("grids").at(1);
    EXPECT_EQ(grid.at("name"), "Cd");
    EXPECT_EQ(grid.at("value_type"), "vec3s");
    EXPECT_EQ(grid.at("metadata").at("vector_type"), "invariant");
    EXPECT_EQ(grid.at("bandvox").at("source"), "cube.obj");
}

TEST(ConvertColor, MissingTextureIsAWarning) {
    const TemporaryFolder folder;
    writeText(folder / "m.mtl", "newmtl m\nKd 1 0 0\nmap_Kd none.png\n");
    writeText(folder / "cube.obj", "mtllib m.mtl\nusemtl m\n" + cubeObj());
    const RunOptions here{.folder = folder.path()};
    const RunResult result =
        runBandvox({"convert", "cube.obj", "-o", "c.vdb", "-r", "16", "--color"}, here);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("warning: the texture \"none.png\" does not exist"),
              std::string::npos)
        << result.err;
    const RunResult strict =
        runBandvox({"convert", "cube.obj", "-o", "s.vdb", "-r", "16", "--color", "--strict"}, here);
    EXPECT_EQ(strict.status, 3);
    EXPECT_FALSE(std::filesystem::exists(folder / "s.vdb"));
}

TEST(ConvertColor, RefusesWhatHasNone) {
    const TemporaryFolder folder;
    writeText(folder / "cube.obj", cubeObj());
    const RunOptions here{.folder = folder.path()};
    const RunResult plain =
        runBandvox({"convert", "cube.obj", "-o", "c.vdb", "-r", "16", "--color"}, here);
    EXPECT_EQ(plain.status, 3);
    EXPECT_NE(plain.err.find("cube.obj\" has no colours"), std::string::npos) << plain.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "c.vdb"));
    const RunResult shape =
        runBandvox({"convert", "shape:torus", "-o", "t.vdb", "-r", "16", "--color"}, here);
    EXPECT_EQ(shape.status, 2);
    EXPECT_NE(shape.err.find("--color takes a mesh"), std::string::npos) << shape.err;
}

}  // namespace
}  // namespace bandvox::app_test
