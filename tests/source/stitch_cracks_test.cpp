#include "source/stitch_cracks.h"

#include "source/test_meshes.h"

#include <bandvox/source/close_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// The faces of the unit cube, each a piece of its own, cut into n × n squares with another n for
// each face: no edge of one is an edge of another. Points lie up to `noise` beside their place.
Mesh cubeOfPatches(double noise, bool sameOrientation = true) {
    Mesh mesh;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-noise, noise);
    unsigned n = 1;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int above : {0, 1}) {
            const auto first = static_cast<unsigned>(mesh.points.size());
            ++n;
            for (unsigned i = 0; i <= n; ++i) {
                for (unsigned j = 0; j <= n; ++j) {
                    Vec3d p(uniform(random), uniform(random), uniform(random));
                    p[axis] += above;
                    p[(axis + 1) % 3] += double(i) / n;
                    p[(axis + 2) % 3] += double(j) / n;
                    mesh.points.push_back(p);
                }
            }
            for (unsigned i = 0; i < n; ++i) {
                for (unsigned j = 0; j < n; ++j) {
                    const unsigned a = first + i * (n + 1) + j, b = a + n + 1;
                    openvdb::Vec3I s(a, b, b + 1), t(a, b + 1, a + 1);
                    if (above == 0 && sameOrientation) {
                        std::swap(s[1], s[2]);
                        std::swap(t[1], t[2]);
                    }
                    mesh.triangles.push_back(s);
                    mesh.triangles.push_back(t);
                }
            }
        }
    }
    return mesh;
}

TEST(StitchCracks, EdgesAreSplitWherePointsLieOnThem) {
    for (const bool sameOrientation : {true, false}) {
        const ClosedMesh closed = closeMesh(cubeOfPatches(0, sameOrientation));
        EXPECT_TRUE(test::isClosed(closed.mesh));
        EXPECT_TRUE(closed.report.holes.empty());
        EXPECT_EQ(closed.report.components, 1u);
        EXPECT_GT(closed.report.edgesSplit, 20u);
        EXPECT_NEAR(test::volume(closed.mesh), 1, 1e-12);
        EXPECT_TRUE(test::hasWarning(closed.report, "cracks were stitched"));
    }
}

TEST(StitchCracks, CracksUpToTheToleranceAreClosed) {
    for (const double noise : {1e-7, 1e-6, 2e-5}) {
        const ClosedMesh closed = closeMesh(cubeOfPatches(noise));
        EXPECT_TRUE(test::isClosed(closed.mesh)) << noise;
        EXPECT_TRUE(closed.report.holes.empty()) << noise;
        EXPECT_EQ(closed.report.components, 1u) << noise;
        EXPECT_NEAR(test::volume(closed.mesh), 1, 10 * noise) << noise;
    }
    // Wider ones are not: the faces stay apart, and what closes them encloses next to nothing.
    const ClosedMesh apart = closeMesh(cubeOfPatches(1e-3), {.crackTolerance = 1e-5});
    EXPECT_EQ(apart.report.components, 6u);
    EXPECT_EQ(apart.report.edgesSplit, 0u);
}

TEST(StitchCracks, ClosedMeshesAndRealHolesStayAsTheyAre) {
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 10, 16);
    const Mesh whole = mesh;
    EXPECT_EQ(stitchCracks(mesh, 0.01).edgesSplit, 0u);
    EXPECT_EQ(mesh.triangles, whole.triangles);
    EXPECT_EQ(mesh.points, whole.points);
    mesh.triangles.resize(mesh.triangles.size() - 5);
    const Mesh open = mesh;
    const StitchedCracks stitched = stitchCracks(mesh, 0.01);
    EXPECT_EQ(stitched.edgesSplit + stitched.pointsJoined, 0u);
    EXPECT_EQ(mesh.triangles, open.triangles);
}

// A slit along an edge, with points on both of its sides: half of the mesh is moved by a little.
TEST(StitchCracks, SlitsAreClosed) {
    const Mesh sphere = test::sphere(Vec3d(0.0), 1, 16, 24);
    Mesh mesh;
    for (const openvdb::Vec3I& t : sphere.triangles) {
        const double middle =
            (sphere.points[t[0]].y() + sphere.points[t[1]].y() + sphere.points[t[2]].y()) / 3;
        const Vec3d by(0, middle > 0 ? 1.5e-4 : 0, 0);
        const auto first = static_cast<unsigned>(mesh.points.size());
        for (int k = 0; k < 3; ++k) mesh.points.push_back(sphere.points[t[k]] + by);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.report.crackPoints, 24u);
    EXPECT_EQ(closed.report.components, 1u);
    EXPECT_TRUE(closed.report.holes.empty());
    EXPECT_NEAR(test::volume(closed.mesh), test::volume(sphere), 2e-3);
}

// What is a crack does not depend on how far away other things are.
TEST(StitchCracks, LeavesSmallThingsInAWideSceneAlone) {
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 20, 30);
    mesh.triangles.resize(mesh.triangles.size() - 100);
    const std::size_t triangles = mesh.triangles.size();
    Mesh far = mesh;
    for (Vec3d& p : far.points) p += Vec3d(5000, 0, 0);
    test::append(mesh, far);
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.report.crackPoints, 0u);
    EXPECT_EQ(closed.report.edgesSplit, 0u);
    EXPECT_EQ(closed.report.nonManifoldEdges, 0u);
    EXPECT_GT(closed.mesh.triangles.size(), 2 * triangles);
}

}  // namespace
}  // namespace bandvox
