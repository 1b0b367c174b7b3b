#include "source/test_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/close_mesh.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;
using test::append;
using test::cube;
using test::hasWarning;
using test::isClosed;
using test::reversed;
using test::soup;
using test::sphere;
using test::volume;

ErrorKind errorOf(const Mesh& mesh, const CloseMeshOptions& options = {}) {
    try {
        closeMesh(mesh, options);
    } catch (const Error& error) {
        EXPECT_FALSE(std::string(error.what()).empty());
        return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::Runtime;
}

TEST(CloseMesh, LeavesAClosedMeshAlone) {
    const Mesh mesh = cube(Vec3d(1, 2, 3), 2.0);
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.mesh.points, mesh.points);
    EXPECT_EQ(closed.mesh.triangles, mesh.triangles);
    EXPECT_EQ(closed.report.components, 1u);
    EXPECT_EQ(closed.report.pointsWelded, 0u);
    EXPECT_TRUE(closed.report.holes.empty());
    EXPECT_TRUE(closed.report.warnings.empty());
}

TEST(CloseMesh, WeldsATriangleSoup) {
    const ClosedMesh closed = closeMesh(soup(cube(Vec3d(0), 1.0)));
    EXPECT_EQ(closed.mesh.points.size(), 8u);
    EXPECT_EQ(closed.report.pointsWelded, 36u - 8u);
    EXPECT_EQ(closed.report.components, 1u);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 1.0);
    EXPECT_TRUE(closed.report.warnings.empty());
}

TEST(CloseMesh, WeldsPointsThatDifferByRounding) {
    Mesh mesh = soup(sphere(Vec3d(0), 1.0, 20, 40));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(-5e-8, 5e-8);
    for (Vec3d& p : mesh.points) p += Vec3d(noise(random), noise(random), noise(random));
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.mesh.points.size(), 19u * 40u + 2u);
    EXPECT_TRUE(closed.report.holes.empty());
    EXPECT_EQ(closed.report.components, 1u);

    // Without a tolerance each triangle is a piece of its own, and flat once it is closed.
    EXPECT_EQ(errorOf(mesh, {.weldTolerance = 0.0, .crackTolerance = 0.0}), ErrorKind::Result);
}

TEST(CloseMesh, RemovesPointsThatNoTriangleUses) {
    Mesh mesh;
    mesh.points = {Vec3d(1e9)};
    append(mesh, cube(Vec3d(0), 1.0));
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.mesh.points.size(), 8u);
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 1.0);
}

TEST(CloseMesh, CapsAMissingFace) {
    Mesh mesh = cube(Vec3d(0), 2.0);
    mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 8.0);
    ASSERT_EQ(closed.report.holes.size(), 1u);
    EXPECT_EQ(closed.report.holes[0].edges, 4u);
    EXPECT_DOUBLE_EQ(closed.report.holes[0].perimeter, 8.0);
    EXPECT_EQ(closed.report.holes[0].center, Vec3d(2, 1, 1));
    EXPECT_TRUE(hasWarning(closed.report, "1 hole capped (largest: 4 edges, perimeter 8)"));
}

TEST(CloseMesh, CapsAMissingTriangleByOne) {
    for (std::size_t i = 0; i < 12; ++i) {
        Mesh mesh = cube(Vec3d(0), 2.0);
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i));
        const ClosedMesh closed = closeMesh(mesh);
        EXPECT_TRUE(isClosed(closed.mesh));
        EXPECT_EQ(closed.mesh.points.size(), 8u);
        EXPECT_EQ(closed.mesh.triangles.size(), 12u);
        EXPECT_DOUBLE_EQ(volume(closed.mesh), 8.0);
    }
}

TEST(CloseMesh, CapsHolesThatTouchInAPointOneByOne) {
    // Around the pole of a sphere, every second triangle is missing: 10 holes of three edges
    // that all touch there.
    Mesh mesh = sphere(Vec3d(0), 1.0, 10, 20);
    std::vector<Vec3I> kept;
    int atPole = 0;
    for (const Vec3I& t : mesh.triangles) {
        if (t[0] == 0 && atPole++ % 2 == 0) continue;
        kept.push_back(t);
    }
    const double expected = volume(mesh);
    mesh.triangles = kept;
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_EQ(closed.report.holes.size(), 10u);
    for (const CappedHole& hole : closed.report.holes) EXPECT_EQ(hole.edges, 3u);
    EXPECT_NEAR(volume(closed.mesh), expected, 1e-12);
}

TEST(CloseMesh, ReportsHolesInOrderOfFallingPerimeter) {
    Mesh mesh = sphere(Vec3d(0), 1.0, 12, 24);
    // Cut off the cap at one pole, and one quadrilateral elsewhere.
    std::erase_if(mesh.triangles, [&mesh](const Vec3I& t) {
        return mesh.points[t[0]].y() > 0.9 || mesh.points[t[1]].y() > 0.9 ||
               mesh.points[t[2]].y() > 0.9;
    });
    mesh.triangles.erase(mesh.triangles.begin() + 101);
    const ClosedMesh closed = closeMesh(mesh);
    ASSERT_EQ(closed.report.holes.size(), 2u);
    EXPECT_EQ(closed.report.holes[0].edges, 24u);
    EXPECT_GT(closed.report.holes[0].perimeter, closed.report.holes[1].perimeter);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_TRUE(hasWarning(closed.report, "2 holes capped (largest: 24 edges"));
}

TEST(CloseMesh, CubesThatShareAnEdgeStaySolid) {
    Mesh mesh = cube(Vec3d(0), 1.0);
    append(mesh, cube(Vec3d(1, 1, 0), 1.0));
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.report.components, 2u);
    EXPECT_EQ(closed.report.nonManifoldEdges, 1u);
    EXPECT_TRUE(hasWarning(closed.report, "1 edge is shared by more than two triangles"));
    EXPECT_TRUE(closed.report.holes.empty());
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 2.0);
}

TEST(CloseMesh, AWallBetweenTwoCubesDoesNotMatter) {
    // Both cubes have the wall: its two sides cancel.
    Mesh both = cube(Vec3d(0), 1.0);
    append(both, cube(Vec3d(1, 0, 0), 1.0));
    ClosedMesh closed = closeMesh(both);
    EXPECT_EQ(closed.report.duplicateTriangles, 4u);
    EXPECT_EQ(closed.report.components, 1u);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 2.0);

    // One wall is missing: its edges belong to three triangles.
    Mesh single = cube(Vec3d(0), 1.0);
    Mesh second = cube(Vec3d(1, 0, 0), 1.0);
    second.triangles.erase(second.triangles.begin(), second.triangles.begin() + 2);
    append(single, second);
    closed = closeMesh(single);
    EXPECT_EQ(closed.report.nonManifoldEdges, 4u);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 2.0);
}

TEST(CloseMesh, ASurfaceWithBothSidesDrawnIsTakenOnce) {
    const Mesh mesh = sphere(Vec3d(0), 1.0, 10, 20);
    Mesh twice = mesh;
    append(twice, reversed(mesh));
    const ClosedMesh closed = closeMesh(twice);
    EXPECT_EQ(closed.report.duplicateTriangles, mesh.triangles.size());
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_NEAR(volume(closed.mesh), volume(mesh), 1e-12);
    EXPECT_TRUE(hasWarning(closed.report, "same corners"));

    Mesh same = mesh;
    append(same, mesh);
    EXPECT_NEAR(volume(closeMesh(same).mesh), volume(mesh), 1e-12);
}

TEST(CloseMesh, CountsTrianglesWithoutArea) {
    // The middle of an edge of a cube is a corner of a triangle without area.
    Mesh mesh = cube(Vec3d(0), 2.0);
    const Vec3I split = mesh.triangles[0];
    const auto middle = static_cast<unsigned>(mesh.points.size());
    mesh.points.push_back(0.5 * (mesh.points[split[0]] + mesh.points[split[1]]));
    mesh.triangles[0] = Vec3I(middle, split[1], split[2]);
    mesh.triangles.emplace_back(split[0], middle, split[2]);
    mesh.triangles.emplace_back(split[0], split[1], middle);
    // And two that have corners in common, one after welding.
    mesh.triangles.emplace_back(1, 1, 2);
    mesh.points.push_back(mesh.points[5]);
    mesh.triangles.emplace_back(5, 9, 2);
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.report.degenerateTriangles, 3u);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_TRUE(closed.report.holes.empty());
    EXPECT_DOUBLE_EQ(volume(closed.mesh), 8.0);
}

TEST(CloseMesh, RefusesWhatHasNoVolume) {
    EXPECT_EQ(errorOf(Mesh{}), ErrorKind::Input);
    Mesh mesh;
    mesh.points = {Vec3d(0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(1, 1, 0)};
    EXPECT_EQ(errorOf(mesh), ErrorKind::Input);
    mesh.triangles = {Vec3I(0, 0, 1)};
    EXPECT_EQ(errorOf(mesh), ErrorKind::Input);
    mesh.triangles = {Vec3I(0, 1, 2)};
    EXPECT_EQ(errorOf(mesh), ErrorKind::Result);
    mesh.triangles = {Vec3I(0, 1, 2), Vec3I(1, 3, 2)};
    EXPECT_EQ(errorOf(mesh), ErrorKind::Result);
    mesh.triangles = {Vec3I(0, 1, 2), Vec3I(0, 2, 1)};
    EXPECT_EQ(errorOf(mesh), ErrorKind::Result);
    mesh.points.assign(4, Vec3d(7));
    EXPECT_EQ(errorOf(mesh), ErrorKind::Input);
}

TEST(CloseMesh, RefusesMalformedInput) {
    Mesh mesh = cube(Vec3d(0), 1.0);
    mesh.triangles[3][1] = 8;
    EXPECT_EQ(errorOf(mesh), ErrorKind::Input);
    mesh = cube(Vec3d(0), 1.0);
    mesh.points[2].y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errorOf(mesh), ErrorKind::Input);
    mesh.points[2].y() = std::numeric_limits<double>::infinity();
    EXPECT_EQ(errorOf(mesh), ErrorKind::Input);
    EXPECT_EQ(errorOf(cube(Vec3d(0), 1.0), {.weldTolerance = -1.0}), ErrorKind::Usage);
    EXPECT_EQ(errorOf(cube(Vec3d(0), 1.0), {.weldTolerance = 1.0}), ErrorKind::Usage);
}

TEST(CloseMesh, StopsWhenAsked) {
    class Stop final : public Progress {
      public:
        bool interrupted() const override { return true; }
    };
    Stop stop;
    try {
        closeMesh(cube(Vec3d(0), 1.0), {}, stop);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

TEST(CloseMesh, AnyTrianglesBecomeClosed) {
    // Random triangles over few points: every kind of defect, and always a balanced result.
    std::mt19937 random(17);
    int solved = 0;
    for (int trial = 0; trial < 300; ++trial) {
        Mesh mesh;
        const unsigned points = 4 + random() % 12;
        std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
        for (unsigned i = 0; i < points; ++i) {
            mesh.points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
        }
        const unsigned triangles = 1 + random() % 60;
        for (unsigned i = 0; i < triangles; ++i) {
            mesh.triangles.emplace_back(random() % points, random() % points, random() % points);
        }
        try {
            const ClosedMesh closed = closeMesh(mesh);
            EXPECT_TRUE(isClosed(closed.mesh)) << trial;
            EXPECT_GE(closed.mesh.triangles.size(), 2u);
            ++solved;
        } catch (const Error& error) {
            EXPECT_TRUE(error.kind() == ErrorKind::Input || error.kind() == ErrorKind::Result);
        }
    }
    EXPECT_GT(solved, 100);
}

}  // namespace
}  // namespace bandvox
