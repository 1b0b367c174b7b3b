// Which pieces of a mesh are capped, and which are left to their winding number.

#include "soup_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/winding_number.h>

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox {
namespace {

using openvdb::Vec3d;

ClosedMesh close(const Mesh& mesh, Capping capping = Capping::Sensible) {
    return closeMesh(mesh, {.capping = capping});
}

// The octants of a ball, pulled apart.
Mesh octants(double gap) {
    Mesh mesh;
    const Mesh ball = test::sphere(Vec3d(0.0), 1, 16, 32);
    for (int octant = 0; octant < 8; ++octant) {
        const Vec3d sign(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
        Mesh part = ball;
        std::erase_if(part.triangles, [&](const openvdb::Vec3I& t) {
            const Vec3d sum = ball.points[t[0]] + ball.points[t[1]] + ball.points[t[2]];
            return sum.x() * sign.x() < 0 || sum.y() * sign.y() < 0 || sum.z() * sign.z() < 0;
        });
        for (Vec3d& p : part.points) p += gap * sign;
        test::append(mesh, part);
    }
    return mesh;
}

TEST(SeparateSoup, PanelsAreSoup) {
    for (const Mesh& mesh : {test::panels(0.02), test::askew(test::panels(0.02)),
                             test::reversed(test::panels(0.05))}) {
        const ClosedMesh closed = close(mesh);
        EXPECT_EQ(closed.report.soupPieces, 6u);
        EXPECT_EQ(closed.report.soupTriangles, 12u);
        EXPECT_TRUE(closed.mesh.triangles.empty());
        EXPECT_TRUE(closed.report.holes.empty());
        EXPECT_TRUE(closed.report.problem.empty());
        EXPECT_TRUE(test::hasWarning(closed.report, "winding number"));
        // It faces outward.
        EXPECT_NEAR(WindingNumber(closed.soup).exactAt(Vec3d(0.1)), 1, 0.1);
    }
}

TEST(SeparateSoup, PanelsThatDisagreeAreTurned) {
    for (unsigned which = 1; which < 63; which += 3) {
        Mesh mesh = test::askew(test::panels(0.03));
        for (unsigned panel = 0; panel < 6; ++panel) {
            if ((which >> panel & 1) == 0) continue;
            for (unsigned k = 0; k < 2; ++k) {
                std::swap(mesh.triangles[2 * panel + k][1], mesh.triangles[2 * panel + k][2]);
            }
        }
        const ClosedMesh closed = close(mesh);
        EXPECT_EQ(closed.report.soupPieces, 6u) << which;
        EXPECT_NEAR(WindingNumber(closed.soup).exactAt(Vec3d(0.1)), 1, 0.1) << which;
    }
}

TEST(SeparateSoup, ShellsThatWereCutUpAreSoup) {
    const ClosedMesh closed = close(octants(0.01));
    EXPECT_EQ(closed.report.soupPieces, 8u);
    EXPECT_NEAR(WindingNumber(closed.soup).exactAt(Vec3d(0.1)), 1, 0.1);
}

TEST(SeparateSoup, ShredsAreSoup) {
    // More pieces than are looked at one by one.
    const ClosedMesh closed = close(test::shredded(test::sphere(Vec3d(0.0), 1, 40, 60), 0.1));
    EXPECT_EQ(closed.report.soupPieces, closed.report.components);
    EXPECT_GT(closed.report.soupPieces, 4000u);
}

TEST(SeparateSoup, WhatCapsCloseIsCapped) {
    Mesh hemisphere = test::sphere(Vec3d(0.0), 1, 20, 30);
    std::erase_if(hemisphere.triangles, [&](const openvdb::Vec3I& t) {
        return hemisphere.points[t[0]].y() + hemisphere.points[t[1]].y() > 1e-9;
    });
    Mesh box = test::cube(Vec3d(0.0), 1);
    box.triangles.resize(10);
    Mesh tetrahedron = test::tetrahedron(Vec3d(0.0), 1);
    tetrahedron.triangles.resize(3);
    Mesh many;
    for (int i = 0; i < 1500; ++i) {
        Mesh one = test::tetrahedron(2.0 * Vec3d(i % 12, i / 12 % 12, i / 144), 1);
        one.triangles.erase(one.triangles.begin() + i % 4);
        test::append(many, one);
    }
    Mesh thin = test::thinned(test::sphere(Vec3d(0.0), 1, 60, 90), 0.01, 5);
    for (Mesh* mesh : {&hemisphere, &box, &tetrahedron, &many, &thin}) {
        const ClosedMesh closed = close(*mesh);
        EXPECT_EQ(closed.report.soupPieces, 0u) << mesh->triangles.size();
        EXPECT_TRUE(closed.soup.triangles.empty());
        EXPECT_TRUE(test::isClosed(closed.mesh));
    }
}

TEST(SeparateSoup, TakesTheSoupAndLeavesTheRest) {
    Mesh mesh = test::panels(0.02);
    Mesh ball = test::sphere(Vec3d(4, 0, 0), 1, 20, 30);
    ball.triangles.resize(ball.triangles.size() - 20);
    test::append(mesh, ball);
    const ClosedMesh closed = close(mesh);
    EXPECT_EQ(closed.report.soupPieces, 6u);
    EXPECT_EQ(closed.report.components, 7u);
    EXPECT_EQ(closed.report.holes.size(), 1u);
    EXPECT_TRUE(test::isClosed(closed.mesh));
    EXPECT_NEAR(test::volume(closed.mesh), 4.0, 0.2);
    EXPECT_EQ(closed.soup.triangles.size(), 12u);
}

TEST(SeparateSoup, SheetsThatEncloseNothingAreNoSoup) {
    // Two panels of a box, far apart.
    Mesh mesh = test::panels(0.02);
    mesh.triangles.resize(4);
    EXPECT_THROW(close(mesh), Error);
    // Beside a soup they add nothing to it.
    Mesh sheet = mesh;
    for (Vec3d& p : sheet.points) p += Vec3d(10, 0, 0);
    Mesh both = test::panels(0.02);
    test::append(both, sheet);
    const ClosedMesh closed = close(both);
    EXPECT_GE(closed.report.soupPieces, 6u);
    EXPECT_TRUE(closed.mesh.triangles.empty());
    // Beside a solid they are said to enclose nothing.
    Mesh beside = test::cube(Vec3d(20, 0, 0), 2);
    test::append(beside, mesh);
    const ClosedMesh cube = close(beside);
    EXPECT_EQ(cube.report.soupPieces, 0u);
    EXPECT_EQ(cube.report.sheets, 2u);
    EXPECT_NEAR(test::volume(cube.mesh), 8, 1e-9);
}

// So many openings that look the same way add up, far from all of them.
TEST(SeparateSoup, ThousandsOfOpenBoxesAreCapped) {
    Mesh mesh;
    for (int i = 0; i < 1000; ++i) {
        Mesh box = test::cube(1.5 * Vec3d(i % 10, i / 10 % 10, i / 100), 1);
        box.triangles.resize(10);
        test::append(mesh, box);
    }
    const ClosedMesh closed = close(mesh);
    EXPECT_EQ(closed.report.soupPieces, 0u);
    EXPECT_EQ(closed.report.holes.size(), 1000u);
    EXPECT_NEAR(test::volume(closed.mesh), 1000, 1e-6);
}

TEST(SeparateSoup, DoesNotMindASolidBesideIt) {
    // Outward or not, much larger or not.
    for (const double side : {2.0, 40.0}) {
        for (const bool isInsideOut : {false, true}) {
            Mesh mesh = test::cube(Vec3d(3, -side / 2, -side / 2), side);
            if (isInsideOut) mesh = test::reversed(mesh);
            test::append(mesh, test::panels(0.02));
            const ClosedMesh closed = close(mesh);
            EXPECT_EQ(closed.report.soupPieces, 6u) << side << isInsideOut;
            EXPECT_NEAR(test::volume(closed.mesh), side * side * side, 1e-6 * side);
            EXPECT_NEAR(WindingNumber(closed.soup).exactAt(Vec3d(0.1)), 1, 0.1);
        }
    }
}

TEST(SeparateSoup, WhatIsLeftOfABallIsStillABall) {
    const Mesh ball = test::sphere(Vec3d(0.0), 1, 24, 48);
    for (const double part : {0.3, 0.35, 0.4, 0.45}) {
        const ClosedMesh closed = close(test::thinned(ball, part, 17));
        // Whether or not the largest piece can be capped, what is inside stays inside.
        const double inside = WindingNumber(closed.soup).exactAt(Vec3d(0.05)) +
                              WindingNumber(closed.mesh).exactAt(Vec3d(0.05));
        EXPECT_GT(inside, 0.51) << part;
        if (part > 0.38) {
            EXPECT_GT(closed.report.soupTriangles, ball.triangles.size() / 3) << part;
        }
    }
}

TEST(SeparateSoup, AllOrNothingCanBeAskedFor) {
    const Mesh mesh = test::sphere(Vec3d(0.0), 1, 20, 30);
    const ClosedMesh none = close(mesh, Capping::None);
    EXPECT_EQ(none.soup.triangles.size(), mesh.triangles.size());
    EXPECT_TRUE(none.mesh.triangles.empty());
    // Capped, panels are flat.
    EXPECT_THROW(close(test::panels(0.02), Capping::All), Error);
}

}  // namespace
}  // namespace bandvox
