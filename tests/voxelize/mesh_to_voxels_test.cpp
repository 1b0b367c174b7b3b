#include "source/test_meshes.h"
#include "voxelize/exact_winding.h"
#include "voxelize/voxel_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/voxelize/mesh_to_voxels.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

VoxelResult voxelize(const Mesh& mesh, double voxelSize = 1) {
    return meshToVoxels(MeshSource("a.obj", mesh), {.voxelSize = voxelSize});
}

ErrorKind kindOfFailure(const Mesh& mesh, const VoxelOptions& options,
                        Progress& progress = silentProgress()) {
    try {
        meshToVoxels(MeshSource("a.obj", mesh), options, progress);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "voxels came";
    return ErrorKind::Runtime;
}

/// The voxels of a mesh's box, and two more on each side.
CoordBBox boxAround(const Mesh& mesh) {
    const openvdb::BBoxd bounds = MeshSource("", mesh).bounds();
    return CoordBBox(Coord::floor(bounds.min()).offsetBy(-2),
                     Coord::ceil(bounds.max()).offsetBy(2));
}

/// Expects a grid to be 1 and active where `inside` says so, else 0 and not active.
void expectVoxels(const VoxelResult& result, const CoordBBox& box,
                  const std::function<bool(const Coord&)>& inside) {
    const auto accessor = result.grid->getConstAccessor();
    std::int64_t count = 0;
    for (auto voxel = box.begin(); voxel; ++voxel) {
        const bool expected = inside(*voxel);
        ASSERT_EQ(accessor.getValue(*voxel), expected ? 1.0F : 0.0F) << *voxel;
        ASSERT_EQ(accessor.isValueOn(*voxel), expected) << *voxel;
        count += expected;
    }
    EXPECT_EQ(result.voxels, count);
    EXPECT_EQ(static_cast<std::int64_t>(result.grid->activeVoxelCount()), count);
}

void expectAsOracle(const Mesh& mesh) {
    ASSERT_TRUE(test::isClosed(mesh));
    expectVoxels(voxelize(mesh), boxAround(mesh),
                 [&](const Coord& voxel) { return test::exactWinding(mesh, voxel) > 0; });
}

TEST(MeshToVoxels, ACubeOnTheLatticeOwnsItsLowerFaces) {
    const VoxelResult result = voxelize(test::cube(Vec3d(-3, 1, 5), 6));
    const CoordBBox cube(Coord(-3, 1, 5), Coord(2, 6, 10));
    expectVoxels(result, CoordBBox(Coord(-6, -2, 2), Coord(6, 10, 14)),
                 [&](const Coord& voxel) { return cube.isInside(voxel); });
}

TEST(MeshToVoxels, AgreesWithTheOracleOnLatticePointsAndPlanes) {
    expectAsOracle(test::octahedron(Vec3d(1, -2, 3), 6));
    expectAsOracle(test::tetrahedron(Vec3d(-4, 0, 2), 9));
    for (const double parts : {1.0, 2.0, 4.0}) {
        SCOPED_TRACE(parts);
        expectAsOracle(test::snapped(test::sphere(Vec3d(0, 0, 0), 9, 12, 16), parts));
        expectAsOracle(test::snapped(test::sphere(Vec3d(-7.3, 12.1, 3.6), 8.2, 9, 11), parts));
        // Many triangles collapse, most edges lie on the lattice.
        expectAsOracle(test::snapped(test::sphere(Vec3d(0.5, 0.5, 0.5), 4, 24, 32), parts));
    }
}

TEST(MeshToVoxels, AgreesWithTheOracleOnRandomTriangles) {
    // Four tetrahedra of any orientation, the first one outward: windings of any sign.
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coordinate(-40, 40);
    for (int round = 0; round < 20; ++round) {
        Mesh mesh;
        for (int i = 0; i < 4; ++i) {
            Mesh simplex;
            for (int k = 0; k < 4; ++k) {
                simplex.points.emplace_back(coordinate(random), coordinate(random),
                                            coordinate(random));
                simplex.points.back() /= static_cast<double>(test::kParts);
            }
            simplex.triangles = test::tetrahedron(Vec3d(0.0), 1).triangles;
            if (test::volume(simplex) == 0) continue;
            test::append(mesh,
                         i > 0 || test::volume(simplex) > 0 ? simplex : test::reversed(simplex));
        }
        SCOPED_TRACE(round);
        expectAsOracle(mesh);
    }
}

TEST(MeshToVoxels, IsTheSameAlongEveryAxis) {
    std::vector<test::NamedMesh> meshes = test::hardMeshes();
    // Shells that overlap, and one inside out.
    Mesh shells = test::sphere(Vec3d(-3, 0, 0), 7, 20, 30);
    test::append(shells, test::cube(Vec3d(0, 0, 0), 9));
    test::append(shells, test::reversed(test::cube(Vec3d(12), 5)));
    meshes.push_back({"shells", shells});
    for (const auto& [name, mesh] : meshes) {
        SCOPED_TRACE(name);
        const MeshSource source(name, mesh);
        const VoxelResult x = meshToVoxels(source, {.voxelSize = 1});
        for (const ScanAxis axis : {ScanAxis::Y, ScanAxis::Z}) {
            test::expectSameVoxels(x, meshToVoxels(source, {.voxelSize = 1, .axis = axis}));
        }
        const VoxelResult parts = meshToVoxels(source, {.voxelSize = 1, .fraction = true});
        for (const ScanAxis axis : {ScanAxis::Y, ScanAxis::Z}) {
            test::expectSameVoxels(
                parts, meshToVoxels(source, {.voxelSize = 1, .fraction = true, .axis = axis}));
        }
    }
}

TEST(MeshToVoxels, CountsSubSamplesAsTheOracleDoes) {
    for (const Mesh& mesh :
         {test::octahedron(Vec3d(1.25, -2.5, 3.75), 6.5), test::cube(Vec3d(-1.25, 0.5, 2), 7.75),
          test::snapped(test::sphere(Vec3d(0.3, -0.7, 0.1), 6, 9, 11), 8)}) {
        // On the lattice of sub-samples, number s of which lies at (s - 1/2) / 2.
        const Mesh fine = test::placed(mesh, Vec3d(2.0), Vec3d(0.5));
        const MeshSource source("a.obj", mesh);
        const auto expectShares = [&](const VoxelResult& result, const auto& valueOf) {
            double sum = 0;
            for (auto voxel = boxAround(mesh).begin(); voxel; ++voxel) {
                int inside = 0;
                for (int i = 0; i < 8; ++i) {
                    const Coord sample = (*voxel << 1) + Coord(i & 1, i >> 1 & 1, i >> 2);
                    inside += test::exactWinding(fine, sample) > 0 ? 1 : 0;
                }
                const float expected = valueOf(inside);
                ASSERT_EQ(result.grid->tree().getValue(*voxel), expected) << *voxel;
                ASSERT_EQ(result.grid->tree().isValueOn(*voxel), expected > 0) << *voxel;
                sum += expected;
            }
            EXPECT_DOUBLE_EQ(result.volume, sum);
            EXPECT_EQ(result.voxels, static_cast<std::int64_t>(result.grid->activeVoxelCount()));
        };
        expectShares(meshToVoxels(source, {.voxelSize = 1, .fraction = true}),
                     [](int inside) { return static_cast<float>(inside) / 8; });
        for (const int threshold : {1, 3, 8}) {
            expectShares(meshToVoxels(source, {.voxelSize = 1, .threshold = threshold}),
                         [&](int inside) { return inside >= threshold ? 1.0F : 0.0F; });
        }
    }
}

TEST(MeshToVoxels, SubSamplesAreNearerToTheVolume) {
    const MeshSource source("a.obj", test::turned(test::torus(1, 0.4, 200, 100)));
    const auto errorOf = [&](const VoxelOptions& options) {
        return std::abs(meshToVoxels(source, options).volume - source.volume()) / source.volume();
    };
    EXPECT_LT(errorOf({.resolution = 40, .fraction = true}), 2e-3);
    EXPECT_LT(errorOf({.resolution = 40, .threshold = 5}), 0.05);
    double last = HUGE_VAL;
    for (int threshold = 1; threshold <= 8; ++threshold) {
        const double volume =
            meshToVoxels(source, {.resolution = 40, .threshold = threshold}).volume;
        EXPECT_LE(volume, last);
        last = volume;
    }
}

TEST(MeshToVoxels, SolidsThatShareFacesShareNoVoxel) {
    // A cube cut into five tetrahedra; the corners are numbered x + 2y + 4z.
    const Mesh cube = test::cube(Vec3d(2, 3, -5), 8);
    const int corners[5][4]{{1, 0, 3, 5}, {2, 0, 6, 3}, {4, 0, 5, 6}, {7, 3, 6, 5}, {0, 3, 5, 6}};
    std::int64_t sum = 0;
    std::vector<VoxelResult> parts;
    for (const auto& corner : corners) {
        Mesh part;
        for (const int i : corner) part.points.push_back(cube.points[i]);
        part.triangles = test::tetrahedron(Vec3d(0.0), 1).triangles;
        if (test::volume(part) < 0) part = test::reversed(part);
        parts.push_back(voxelize(part));
        sum += parts.back().voxels;
    }
    EXPECT_EQ(sum, 512);
    for (auto voxel = CoordBBox(Coord(2, 3, -5), Coord(9, 10, 2)).begin(); voxel; ++voxel) {
        int owners = 0;
        for (const VoxelResult& part : parts) owners += part.grid->tree().isValueOn(*voxel);
        ASSERT_EQ(owners, 1) << *voxel;
    }
}

TEST(MeshToVoxels, AgreesWithTheFormulaOfASphere) {
    const Vec3d center(3.3, -1.2, 0.7);
    constexpr double kRadius = 31.7;
    const Mesh mesh = test::sphere(center, kRadius, 180, 360);
    // The flat triangles stay within this distance of the sphere.
    constexpr double kDeviation = 0.01;
    const VoxelResult result = voxelize(mesh);
    const auto accessor = result.grid->getConstAccessor();
    int unsure = 0;
    for (auto voxel = boxAround(mesh).begin(); voxel; ++voxel) {
        const double distance = ((*voxel).asVec3d() - center).length() - kRadius;
        if (std::abs(distance) < kDeviation) {
            ++unsure;
            continue;
        }
        ASSERT_EQ(accessor.getValue(*voxel) > 0, distance < 0) << *voxel;
    }
    EXPECT_LT(unsure, 400);
    EXPECT_NEAR(static_cast<double>(result.voxels), test::volume(mesh), 0.002 * test::volume(mesh));
}

TEST(MeshToVoxels, OverlappingShellsFormAUnion) {
    const Mesh left = test::sphere(Vec3d(-3.1, 0.2, 0), 7, 20, 30);
    const Mesh right = test::sphere(Vec3d(4.2, 1, -0.4), 6, 20, 30);
    Mesh both = left;
    test::append(both, right);
    const VoxelResult l = voxelize(left), r = voxelize(right);
    const VoxelResult result = voxelize(both);
    expectVoxels(result, boxAround(both), [&](const Coord& voxel) {
        return l.grid->tree().isValueOn(voxel) || r.grid->tree().isValueOn(voxel);
    });
    EXPECT_LT(result.voxels, l.voxels + r.voxels);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(MeshToVoxels, ACavityStaysEmpty) {
    Mesh mesh = test::cube(Vec3d(-8), 16);
    test::append(mesh, test::reversed(test::cube(Vec3d(-4), 8)));
    const CoordBBox outer(Coord(-8), Coord(7)), inner(Coord(-4), Coord(3));
    expectVoxels(voxelize(mesh), boxAround(mesh), [&](const Coord& voxel) {
        return outer.isInside(voxel) && !inner.isInside(voxel);
    });
}

TEST(MeshToVoxels, WhatIsInsideOutCountsAsOutside) {
    Mesh mesh = test::cube(Vec3d(0.0), 5);
    test::append(mesh, test::reversed(test::cube(Vec3d(10, 0, 0), 5)));
    const VoxelResult result = voxelize(mesh);
    EXPECT_EQ(result.voxels, 125);
    EXPECT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(kindOfFailure(test::reversed(test::cube(Vec3d(0.0), 5)), {.voxelSize = 1}),
              ErrorKind::Result);
}

TEST(MeshToVoxels, MakesAGridThatOthersUnderstand) {
    const MeshSource source("part.stl", test::cube(Vec3d(-1), 2));
    const VoxelResult result = meshToVoxels(source, {.resolution = 300});
    const openvdb::FloatGrid& grid = *result.grid;
    EXPECT_EQ(grid.getName(), "density");
    EXPECT_EQ(grid.getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(grid.background(), 0.0F);
    EXPECT_TRUE(grid.transform().isLinear());
    EXPECT_DOUBLE_EQ(grid.voxelSize().x(), 2.0 / 300);
    EXPECT_EQ(grid.indexToWorld(Coord(0)), Vec3d(0.0));
    EXPECT_EQ(result.voxels, 300 * 300 * 300);
    EXPECT_EQ(grid.evalActiveVoxelBoundingBox(), CoordBBox(Coord(-150), Coord(149)));
    EXPECT_NEAR(densityIntegral(grid), 8, 1e-9);
    // Inside, whole nodes are tiles: there is a cell of 128³ voxels on each side of the origin.
    EXPECT_EQ(grid.tree().getValueDepth(Coord(64)), 1);
    EXPECT_EQ(grid.tree().getValueDepth(Coord(-64)), 1);
    EXPECT_EQ(grid.tree().getValueDepth(Coord(140)), 2);
    EXPECT_LT(grid.memUsage(), std::size_t(300) * 300 * 300);

    EXPECT_EQ(grid.metaValue<std::string>("bandvox_source"), "part.stl");
    EXPECT_FALSE(grid.metaValue<std::string>("bandvox_version").empty());
    EXPECT_EQ(grid.metaValue<double>("bandvox_iso"), 0.5);
    EXPECT_FALSE(densityMetadata(grid)) << "it is not band-limited";
}

TEST(MeshToVoxels, TinyAndLongObjects) {
    // One voxel; and one row, far away, in voxels so fine that indices are large.
    EXPECT_EQ(voxelize(test::cube(Vec3d(0.9), 0.2)).voxels, 1);
    Mesh bar = test::cube(Vec3d(0.0), 1);
    for (Vec3d& p : bar.points) p = Vec3d(p.x() * 1000, p.y() * 0.01, p.z() * 0.01) + Vec3d(5e5);
    const VoxelResult result = voxelize(bar, 0.01);
    EXPECT_EQ(result.voxels, 100000);
    EXPECT_TRUE(result.grid->tree().isValueOn(Coord(50000000)));
}

TEST(MeshToVoxels, IsTheSameForAnyNumberOfThreads) {
    Mesh mesh = test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 40, 60);
    test::append(mesh, test::cube(Vec3d(0.0), 1.2));
    const MeshSource source("a.obj", mesh);
    const auto make = [&](int threads) {
        const ThreadLimit limit(threads);
        return meshToVoxels(source, {.resolution = 90});
    };
    const VoxelResult one = make(1);
    for (const int threads : {2, 4}) {
        const VoxelResult many = make(threads);
        EXPECT_EQ(one.voxels, many.voxels);
        EXPECT_TRUE(one.grid->tree().hasSameTopology(many.grid->tree()));
        for (auto value = one.grid->cbeginValueOn(); value; ++value) {
            ASSERT_EQ(many.grid->tree().getValue(value.getCoord()), *value);
        }
    }
}

TEST(MeshToVoxels, NoCentreInsideIsAFailure) {
    EXPECT_EQ(kindOfFailure(test::cube(Vec3d(0.2), 0.6), {.voxelSize = 1}), ErrorKind::Result);
}

TEST(MeshToVoxels, RefusesAnOpenMesh) {
    // Rows along x see the faces across them, the first four triangles.
    for (const int missing : {0, 1, 2, 3}) {
        Mesh mesh = test::cube(Vec3d(0.1, 0.2, 0.3), 5);
        mesh.triangles.erase(mesh.triangles.begin() + missing);
        EXPECT_EQ(kindOfFailure(mesh, {.voxelSize = 0.25}), ErrorKind::Input) << missing;
    }
}

TEST(MeshToVoxels, RefusesSizesOutOfRange) {
    const Mesh mesh = test::cube(Vec3d(0.0), 2);
    for (const VoxelOptions& options :
         {VoxelOptions{.resolution = 0}, VoxelOptions{.resolution = (1 << 20) + 1},
          VoxelOptions{.voxelSize = -1}, VoxelOptions{.voxelSize = HUGE_VAL},
          VoxelOptions{.voxelSize = std::nan("")}, VoxelOptions{.voxelSize = 1e-7},
          VoxelOptions{.voxelSize = 1e-300}, VoxelOptions{.threshold = 9},
          VoxelOptions{.threshold = -1}, VoxelOptions{.threshold = 2, .fraction = true}}) {
        EXPECT_EQ(kindOfFailure(mesh, options), ErrorKind::Usage) << options.voxelSize;
    }
    EXPECT_EQ(kindOfFailure(test::cube(Vec3d(1e9), 2), {.voxelSize = 0.1}), ErrorKind::Usage);
    EXPECT_EQ(kindOfFailure(mesh, {.voxelSize = 2e-5}), ErrorKind::Memory);
    EXPECT_EQ(kindOfFailure(mesh, {.resolution = 1 << 20}), ErrorKind::Input);
}

class Interrupting final : public Progress {
  public:
    bool interrupted() const override { return true; }
};

TEST(MeshToVoxels, CanBeInterrupted) {
    Interrupting progress;
    EXPECT_EQ(kindOfFailure(test::cube(Vec3d(0.0), 2), {}, progress), ErrorKind::Interrupted);
}

TEST(MeshToVoxels, KeepsTheVolumeOfRealMeshes) {
    const char* folder = std::getenv("BANDVOX_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "BANDVOX_TEST_DATA is not set";
    for (const char* name : {"stanford-bunny.obj", "spot.obj", "fandisk.obj"}) {
        ClosedMesh closed = closeMesh(readMesh(std::filesystem::path(folder) / name).mesh);
        const MeshSource source(name, std::move(closed.mesh));
        const VoxelResult result = meshToVoxels(source, {.resolution = 128});
        const double volume =
            static_cast<double>(result.voxels) * result.grid->transform().voxelVolume();
        // A flat face along the lattice may be off by up to half a voxel all over.
        EXPECT_NEAR(volume, source.volume(), 0.5 * result.grid->voxelSize().x() * source.area())
            << name;
    }
}

}  // namespace
}  // namespace bandvox
