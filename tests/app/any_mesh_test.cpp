// What becomes of meshes that are no solids yet: open, overlapping, inside out, one-sided.

#include "run_command.h"
#include "source/soup_meshes.h"

#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

namespace bandvox::app_test {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;
using openvdb::Vec3d;

class AnyMesh : public testing::Test {
  protected:
    void write(const std::string& name, const Mesh& mesh) {
        std::ofstream file(mFolder / name);
        file.precision(9);
        for (const Vec3d& p : mesh.points) {
            file << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
        }
        for (const openvdb::Vec3I& t : mesh.triangles) {
            file << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
        }
    }

    RunResult run(const Names& arguments) {
        return runBandvox(arguments, {.folder = mFolder.path()});
    }

    /// What the grid of a mesh says of itself, after conversion at 64 voxels.
    DensityMetadata converted(const Mesh& mesh, const Names& more = {}) {
        write("a.obj", mesh);
        Names arguments{"convert", "a.obj", "-o", "a.vdb", "-r", "64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = run(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        mErrors = result.err;
        mGrid = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(mFolder / "a.vdb").front());
        return *densityMetadata(*mGrid);
    }

    TemporaryFolder mFolder;
    std::string mErrors;
    openvdb::FloatGrid::Ptr mGrid;
};

Mesh mobiusStrip() {
    constexpr unsigned kAlong = 80, kAcross = 4;
    Mesh mesh;
    for (unsigned i = 0; i < kAlong; ++i) {
        const double u = 2 * std::numbers::pi * i / kAlong;
        for (unsigned j = 0; j < kAcross; ++j) {
            const double s = -0.3 + 0.6 * j / (kAcross - 1);
            const double r = 1 + s * std::cos(u / 2);
            mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), s * std::sin(u / 2));
        }
    }
    for (unsigned i = 0; i < kAlong; ++i) {
        for (unsigned j = 0; j + 1 < kAcross; ++j) {
            const unsigned a = i * kAcross + j, b = a + 1;
            const bool isLast = i + 1 == kAlong;
            const unsigned c = isLast ? kAcross - 1 - j : a + kAcross;
            const unsigned d = isLast ? kAcross - 2 - j : b + kAcross;
            mesh.triangles.emplace_back(a, b, d);
            mesh.triangles.emplace_back(a, d, c);
        }
    }
    return mesh;
}

TEST_F(AnyMesh, OpenOnesAreCapped) {
    Mesh cube = test::cube(Vec3d(0.0), 1);
    cube.triangles.erase(cube.triangles.begin() + 2, cube.triangles.begin() + 4);
    EXPECT_NEAR(converted(cube).gridVolume, 1, 1e-4);
    EXPECT_NE(mErrors.find("1 hole capped"), std::string::npos) << mErrors;

    Mesh tetrahedron = test::tetrahedron(Vec3d(0.0), 1);
    tetrahedron.triangles.pop_back();
    EXPECT_NEAR(converted(tetrahedron).gridVolume, 1.0 / 6, 1e-4);
}

TEST_F(AnyMesh, InsideOutOnesAreTurned) {
    EXPECT_NEAR(converted(test::reversed(test::cube(Vec3d(0.0), 1))).gridVolume, 1, 1e-4);
}

TEST_F(AnyMesh, APuncturedSphereKeepsItsVolume) {
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 60, 90);
    const double whole = test::volume(mesh);
    std::mt19937 random(4);
    std::erase_if(mesh.triangles, [&](const auto&) { return random() % 100 == 0; });
    EXPECT_NEAR(converted(mesh).gridVolume, whole, 0.01 * whole);
}

TEST_F(AnyMesh, ShellsThatOverlapMakeAUnion) {
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 40, 60);
    const double one = test::volume(mesh);
    test::append(mesh, test::sphere(Vec3d(0.9, 0.2, 0.1), 1, 40, 60));
    const DensityMetadata united = converted(mesh);
    EXPECT_LT(united.sourceVolume, 1.7 * one);
    EXPECT_NEAR(united.gridVolume, united.sourceVolume, 1e-4);
    EXPECT_NE(mErrors.find("warning: shells overlap"), std::string::npos) << mErrors;
    float highest = 0;
    for (auto value = mGrid->cbeginValueOn(); value; ++value) highest = std::max(highest, *value);
    EXPECT_LE(highest, 1 + 1e-4F);
    EXPECT_EQ(run({"convert", "a.obj", "-o", "b.vdb", "-r", "64", "--strict"}).status, 3);

    // As in the paper's metaballs, densities may add up instead.
    const DensityMetadata sum = converted(mesh, {"--overlap", "sum"});
    EXPECT_NEAR(sum.gridVolume, 2 * one, 1e-3);
    highest = 0;
    for (auto value = mGrid->cbeginValueOn(); value; ++value) highest = std::max(highest, *value);
    EXPECT_NEAR(highest, 2, 1e-3);
}

TEST_F(AnyMesh, AOneSidedOneIsRefused) {
    write("strip.obj", mobiusStrip());
    const RunResult result = run({"convert", "strip.obj", "-o", "strip.vdb", "-r", "64"});
    EXPECT_EQ(result.status, 4);
    EXPECT_NE(result.err.find("one-sided"), std::string::npos) << result.err;
    EXPECT_EQ(mFolder.contents(), Names{"strip.obj"});
    const RunResult info = run({"info", "strip.obj", "--json"});
    EXPECT_EQ(info.status, 0) << info.err;
    const Json report = Json::parse(info.out);
    EXPECT_NE(report.at("problem").get<std::string>().find("one-sided"), std::string::npos);
    EXPECT_TRUE(report.at("volume").is_null());
    EXPECT_EQ(report.at("one_sided_pieces"), 1);
}

TEST_F(AnyMesh, ItsHealthIsTold) {
    Mesh mesh = test::cube(Vec3d(0.0), 2);
    mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
    test::append(mesh, test::cube(Vec3d(1), 2));
    write("two.obj", mesh);
    const RunResult result = run({"info", "two.obj", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Json report = Json::parse(result.out);
    EXPECT_EQ(report.at("triangles"), 22);
    EXPECT_EQ(report.at("pieces"), 2);
    ASSERT_EQ(report.at("holes").size(), 1u);
    EXPECT_EQ(report.at("holes").at(0).at("edges"), 4);
    EXPECT_NEAR(report.at("holes").at(0).at("perimeter").get<double>(), 8, 1e-6);
    EXPECT_GT(report.at("triangle_meetings").get<int>(), 5);
    EXPECT_NEAR(report.at("volume").get<double>(), 15, 1e-6);
    EXPECT_NEAR(report.at("area").get<double>(), 42, 1e-6);
    EXPECT_FALSE(report.at("closed").get<bool>());
    EXPECT_TRUE(report.at("problem").is_null());

    const RunResult words = run({"info", "two.obj"});
    for (const char* said : {"pieces          2", "4 edges, perimeter 8", "volume          15"}) {
        EXPECT_NE(words.out.find(said), std::string::npos) << said << " in " << words.out;
    }
    write("cube.obj", test::cube(Vec3d(0.0), 1));
    EXPECT_NE(run({"info", "cube.obj"}).out.find("closed          yes"), std::string::npos);
}

TEST_F(AnyMesh, ManyPiecesAreNoTrouble) {
    Mesh mesh;
    for (int i = 0; i < 10000; ++i) {
        test::append(mesh, test::tetrahedron(1.5 * Vec3d(i % 22, i / 22 % 22, i / 484), 1));
    }
    const DensityMetadata metadata = converted(mesh);
    EXPECT_NEAR(metadata.gridVolume, 10000.0 / 6, 1e-3 * 10000 / 6);
}

TEST_F(AnyMesh, WhatGoesByItsWindingNumberIsNotForALimitOfMemory) {
    write("a.obj", test::panels(0.01));
    const Names limited{"convert", "a.obj", "-o", "a.vdb", "-r", "32", "--memory-limit", "1G"};
    const RunResult result = run(limited);
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("some goes by its winding number"), std::string::npos) << result.err;
    EXPECT_EQ(mFolder.contents(), Names{"a.obj"});
}

TEST_F(AnyMesh, WhatNoCapsCloseGoesByItsWindingNumber) {
    const DensityMetadata box = converted(test::panels(0.01));
    EXPECT_EQ(box.route, "winding");
    EXPECT_NEAR(box.gridVolume, 8, 0.1);
    EXPECT_GT(box.samplingError, 0);
    EXPECT_LT(box.samplingError, 0.05);
    EXPECT_NE(mErrors.find("6 pieces of 12 triangles are not closed"), std::string::npos)
        << mErrors;
    EXPECT_NE(mErrors.find("measured with every fourth row"), std::string::npos) << mErrors;
    EXPECT_EQ(run({"convert", "a.obj", "-o", "b.vdb", "-r", "64", "--strict"}).status, 3);
    const RunResult finer =
        run({"convert", "a.obj", "-o", "b.vdb", "-r", "64", "--tolerance", "1e-3"});
    EXPECT_EQ(finer.status, 4);
    EXPECT_NE(finer.err.find("sampling error"), std::string::npos) << finer.err;
    EXPECT_EQ(run({"convert", "a.obj", "-o", "b.vdb", "-r", "64", "--route", "exact"}).status, 4);
    EXPECT_EQ(mFolder.contents(), (Names{"a.obj", "a.vdb"}));
    const Json report = Json::parse(run({"info", "a.obj", "--json"}).out);
    EXPECT_EQ(report.at("soup_pieces"), 6);
    EXPECT_EQ(report.at("soup_triangles"), 12);
    EXPECT_TRUE(report.at("volume").is_null());
    const RunResult picture = run({"render", "a.vdb", "-o", "a.png", "--res", "16x16"});
    EXPECT_EQ(picture.status, 0) << picture.err;
}

TEST_F(AnyMesh, SoupsBecomeVoxels) {
    write("panels.obj", test::panels(0.01));
    const RunResult result =
        run({"voxelize", "panels.obj", "-o", "v.vdb", "--voxel-size", "0.0517"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(mFolder / "v.vdb").front());
    EXPECT_NEAR(densityIntegral(*grid), 8, 0.5);
    const RunResult gpu =
        run({"voxelize", "panels.obj", "-o", "w.vdb", "-r", "20", "--backend", "gpu"});
    EXPECT_EQ(gpu.status, 2);
    EXPECT_NE(gpu.err.find("winding number"), std::string::npos) << gpu.err;
}

TEST_F(AnyMesh, OnlyTheSoupOfAMeshDoes) {
    Mesh mesh = test::panels(0.01);
    test::append(mesh, test::cube(Vec3d(3, 0, 0), 1));
    const DensityMetadata both = converted(mesh);
    EXPECT_EQ(both.route, "winding");
    EXPECT_NEAR(both.gridVolume, 9, 0.1);
    EXPECT_NE(mErrors.find("12 triangles set aside"), std::string::npos) << mErrors;
}

TEST_F(AnyMesh, TheRouteCanBeAskedFor) {
    const Mesh cube = test::askew(test::cube(Vec3d(-1.0), 2));
    const DensityMetadata winding =
        converted(cube, {"--route", "winding", "--oversample", "6", "--tolerance", "0.05"});
    EXPECT_EQ(winding.route, "winding");
    EXPECT_EQ(winding.oversampling, 6);
    EXPECT_NEAR(winding.gridVolume, 8, 0.01);
    const RunResult unused = run({"convert", "a.obj", "-o", "b.vdb", "--oversample", "4"});
    EXPECT_EQ(unused.status, 0);
    EXPECT_NE(unused.err.find("--oversample was not used"), std::string::npos) << unused.err;
    EXPECT_EQ(mErrors.find("not closed"), std::string::npos) << mErrors;
    EXPECT_EQ(run({"convert", "a.obj", "-o", "b.vdb", "--route", "sampled"}).status, 2);
    EXPECT_EQ(run({"convert", "shape:cube", "-o", "b.vdb", "--route", "winding"}).status, 2);
}

}  // namespace
}  // namespace bandvox::app_test
