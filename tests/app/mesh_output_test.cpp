// Meshes that convert writes.

#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/source/read_mesh.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::app_test {
namespace {

using Json = nlohmann::json;
using Arguments = std::vector<std::string>;
using openvdb::Vec3d;

class MeshOutputs : public testing::Test {
  protected:
    RunResult run(const Arguments& arguments, RunOptions options = {}) const {
        options.folder = mFolder.path();
        return runBandvox(arguments, options);
    }

    /// Expects success; what was said.
    std::string succeed(const Arguments& arguments) const {
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, 0) << testing::PrintToString(arguments) << result.err;
        EXPECT_EQ(result.out, "");
        return result.err;
    }

    /// Expects the status, one line of error with those words, and no new file.
    void fail(const Arguments& arguments, int status, const Arguments& words,
              const RunOptions& options = {}) const {
        const Arguments before = mFolder.contents();
        const RunResult result = run(arguments, options);
        SCOPED_TRACE(testing::PrintToString(arguments) + " said: " + result.err);
        EXPECT_EQ(result.status, status);
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1);
        for (const std::string& word : words) {
            EXPECT_NE(result.err.find(word), std::string::npos) << word;
        }
        EXPECT_EQ(mFolder.contents(), before);
    }

    Mesh read(const std::string& name) const { return readMesh(mFolder / name).mesh; }

    /// Writes a level set of a ball of radius 2 beside a density of one of radius 1 and colours.
    void writeBalls(const std::string& name, bool isColored) const {
        const auto levelSet =
            openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2.0F, {0, 0, 0}, 0.1F);
        levelSet->setName("surface");
        auto density = openvdb::FloatGrid::create(0);
        density->setName("density");
        density->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
        auto colors = openvdb::Vec3SGrid::create();
        colors->setName("Cd");
        colors->setTransform(density->transformPtr());
        auto values = density->getAccessor();
        auto paint = colors->getAccessor();
        const auto box = openvdb::CoordBBox(openvdb::Coord(-15), openvdb::Coord(15));
        for (auto at = box.begin(); at; ++at) {
            const double distance = (*at).asVec3d().length() - 10;
            values.setValue(*at, static_cast<float>(1 / (1 + std::exp(2 * distance))));
            paint.setValue(*at, openvdb::Vec3f(0.2F, 0.6F, 0.1F));
        }
        openvdb::GridCPtrVec grids{levelSet, density};
        if (isColored) grids.push_back(colors);
        writeVdb(mFolder / name, grids);
    }

    TemporaryFolder mFolder;
};

double farthestFrom(const Mesh& mesh, double radius) {
    double worst = 0;
    for (const Vec3d& p : mesh.points) worst = std::max(worst, std::abs(p.length() - radius));
    return worst;
}

TEST_F(MeshOutputs, EveryKindOfFileFromAShape) {
    for (const std::string extension : {"obj", "ply", "stl", "gltf", "glb", "PLY"}) {
        const std::string name = "ball." + extension;
        const std::string said = succeed({"convert", "shape:sphere", "-o", name, "-r", "24"});
        EXPECT_EQ(countLines(said, "mesh     "), 1) << said;
        EXPECT_EQ(countLines(said, "wrote    "), 1) << said;
        // The filter, a Gaussian of variance 1.98, makes a ball of 12 voxels smaller by 1.98 / 12.
        EXPECT_LT(farthestFrom(read(name), 1 - 1.98 / 144), 0.02 / 12) << name;
    }
    EXPECT_EQ(mFolder.contents().size(), 6u);
}

/// A .ply file without its notes, which tell what it was made from.
std::string withoutNotes(const std::filesystem::path& path) {
    std::string text = readText(path);
    const std::string mark = "comment note: ";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark)) {
        text.erase(at, text.find('\n', at) + 1 - at);
    }
    return text;
}

TEST_F(MeshOutputs, TheSameByWayOfAVdb) {
    writeText(mFolder / "cube.obj", cubeObj());
    succeed({"convert", "cube.obj", "-o", "direct.ply", "-r", "20", "--iso", "0.4"});
    succeed({"convert", "cube.obj", "-o", "cube.vdb", "-r", "20", "--iso", "0.4"});
    succeed({"convert", "cube.vdb", "-o", "later.ply"});
    EXPECT_EQ(withoutNotes(mFolder / "direct.ply"), withoutNotes(mFolder / "later.ply"));
    succeed({"convert", "cube.vdb", "-o", "other.ply", "--iso", "0.6"});
    EXPECT_NE(withoutNotes(mFolder / "direct.ply"), withoutNotes(mFolder / "other.ply"));
    // Through the standard input.
    const RunResult piped = run({"convert", "stdin.vdb", "-o", "piped.ply"},
                                {.standardInput = (mFolder / "cube.vdb").string()});
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_EQ(withoutNotes(mFolder / "piped.ply"), withoutNotes(mFolder / "later.ply"));
    // And the mesh is one that can be converted again, without a word of warning.
    succeed({"convert", "later.ply", "-o", "again.vdb", "-r", "20", "--strict"});
}

TEST_F(MeshOutputs, StatisticsCountTheMesh) {
    succeed({"convert", "shape:torus", "-o", "t.stl", "-r", "32", "--stats", "s.json"});
    const Json statistics = Json::parse(readText(mFolder / "s.json"));
    const Json& counts = statistics.at("counts");
    const auto triangles = counts.at("mesh_triangles").get<std::size_t>();
    EXPECT_EQ(std::filesystem::file_size(mFolder / "t.stl"), 84 + 50 * triangles);
    EXPECT_EQ(counts.at("output_bytes"), 84 + 50 * triangles);
    // A torus: as many points as half of the triangles.
    EXPECT_EQ(counts.at("mesh_points").get<std::size_t>() * 2, triangles);
    EXPECT_NEAR(counts.at("mesh_volume").get<double>() / counts.at("grid_volume").get<double>(), 1,
                0.15);
    EXPECT_EQ(counts.at("iso"), 0.5);
    EXPECT_EQ(counts.at("points_collapsed"), 0);
    succeed({"convert", "shape:torus", "-o", "t.stl", "-r", "32", "--stats", "s.json",
             "--adaptivity", "1"});
    const Json fewer = Json::parse(readText(mFolder / "s.json")).at("counts");
    EXPECT_EQ(fewer.at("mesh_points").get<std::size_t>() +
                  fewer.at("points_collapsed").get<std::size_t>(),
              counts.at("mesh_points").get<std::size_t>());
    EXPECT_LT(fewer.at("mesh_triangles").get<std::size_t>(), triangles / 2);
}

TEST_F(MeshOutputs, AnybodysGridsByName) {
    writeBalls("balls.vdb", false);
    succeed({"convert", "balls.vdb", "-o", "density.ply"});
    EXPECT_LT(farthestFrom(read("density.ply"), 1), 0.003);
    succeed({"convert", "balls.vdb", "-o", "surface.ply", "--grid", "surface"});
    EXPECT_LT(farthestFrom(read("surface.ply"), 2), 0.001);
    succeed({"convert", "balls.vdb", "-o", "within.ply", "--grid", "surface", "--iso", "-0.1"});
    EXPECT_LT(farthestFrom(read("within.ply"), 1.9), 0.003);
    fail({"convert", "balls.vdb", "-o", "x.ply", "--grid", "heat"}, 3, {"'heat'", "'surface'"});
    fail({"convert", "balls.vdb", "-o", "x.ply", "--color"}, 3, {"Cd"});
}

TEST_F(MeshOutputs, ColorsOfAGridOrOfTheMesh) {
    writeBalls("balls.vdb", true);
    EXPECT_NE(succeed({"convert", "balls.vdb", "-o", "c.glb"}).find("coloured"), std::string::npos);
    const ColoredMeshFile file = readColoredMesh(mFolder / "c.glb");
    EXPECT_EQ(file.triangles, file.colored.mesh.triangles.size());
    EXPECT_EQ(file.colored.paints[0].color[0], openvdb::Vec3f(0.2F, 0.6F, 0.1F));
    // An .stl has none, which matters only if they were asked for.
    succeed({"convert", "balls.vdb", "-o", "c.stl"});
    fail({"convert", "balls.vdb", "-o", "x.stl", "--color"}, 2, {"--color", "x.stl"});

    writeText(mFolder / "cube.obj", coloredCubeObj());
    succeed({"convert", "cube.obj", "-o", "cube.ply", "-r", "24", "--color"});
    const ColoredMeshFile cube = readColoredMesh(mFolder / "cube.ply");
    for (std::size_t t = 0; t < cube.colored.mesh.triangles.size(); ++t) {
        const double z = cube.colored.mesh.points[cube.colored.mesh.triangles[t][0]][2];
        // Red below, blue above, in steps of 8 bits.
        EXPECT_NEAR(cube.colored.paints[t].color[0][2], 0.5 + 0.5 * z, 0.06);
    }
    fail({"convert", "cube.obj", "-o", "x.stl", "-r", "24", "--color"}, 2, {"--color", "x.stl"});
}

TEST_F(MeshOutputs, RefusesWhatHasNoMeaning) {
    writeText(mFolder / "cube.obj", cubeObj());
    writeBalls("balls.vdb", false);
    fail({"convert", "cube.obj", "-o", "x.off"}, 2, {"x.off", ".vdb", ".ply", ".glb"});
    fail({"convert", "cube.obj", "-o", "x"}, 2, {"'x'", ".vdb"});
    fail({"convert", "cube.obj", "-o", ".ply"}, 2, {".ply"});
    fail({"convert", "cube.obj", "-o", "x.ply", "--half"}, 2, {"--half"});
    fail({"convert", "cube.obj", "-o", "x.ply", "--compression", "zip"}, 2, {"--compression"});
    fail({"convert", "cube.obj", "-o", "x.ply", "--grid", "density"}, 2, {"--grid"});
    fail({"convert", "cube.obj", "-o", "x.vdb", "--adaptivity", "0.5"}, 2, {"--adaptivity"});
    fail({"convert", "cube.obj", "-o", "x.ply", "--adaptivity", "1.5"}, 2, {"'1.5'"});
    fail({"convert", "cube.obj", "-o", "cube.obj"}, 2, {"same file"});
    for (const std::string option : {"--resolution", "--cutoff", "--tile", "--route"}) {
        fail({"convert", "balls.vdb", "-o", "x.ply", option, "8"}, 2, {option});
    }
    fail({"convert", "balls.vdb", "-o", "x.ply", "--iso", "x"}, 2, {"--iso"});
    fail({"convert", "none.vdb", "-o", "x.ply"}, 3, {"none.vdb"});
    fail({"convert", "balls.vdb", "-o", "x.vdb", "--adaptivity", "1"}, 2, {"--adaptivity"});
    fail({"convert", "balls.vdb", "-o", "x.ply", "--factor", "2"}, 2, {"--factor"});
    fail({"convert", "cube.obj", "-o", "x.ply", "--lod", "2"}, 2, {"--lod"});
}

TEST_F(MeshOutputs, AnEmptySurfaceIsNoResult) {
    writeBalls("balls.vdb", false);
    fail({"convert", "balls.vdb", "-o", "x.ply", "--iso", "1.5"}, 4, {"empty", "1.5"});
    fail({"convert", "balls.vdb", "-o", "x.ply", "--grid", "surface", "--iso", "-1"}, 4, {"empty"});
    fail({"convert", "balls.vdb", "-o", "x.ply", "--grid", "surface", "--iso", "1"}, 2, {"iso"});
    // A rod so thin that its density nowhere reaches the half.
    fail({"convert", "shape:tree", "-o", "x.ply", "-r", "6"}, 4, {"empty"});
}

TEST_F(MeshOutputs, AFullDiskLeavesTheOldFile) {
    for (const std::string extension : {"obj", "ply", "stl", "gltf", "glb"}) {
        const std::string name = "ball." + extension;
        writeText(mFolder / name, "old");
        fail({"convert", "shape:sphere", "-o", name, "-r", "24"}, 1, {name}, {.largestFile = 2000});
        EXPECT_EQ(readText(mFolder / name), "old");
    }
    std::filesystem::create_symlink("/dev/full", mFolder / "full.ply");
    fail({"convert", "shape:sphere", "-o", "full.ply", "-r", "24"}, 1, {"full.ply", "No space"});
}

}  // namespace
}  // namespace bandvox::app_test
