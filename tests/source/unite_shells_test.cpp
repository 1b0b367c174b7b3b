#include "source/test_meshes.h"
#include "source/triangle_meetings.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/unite_shells.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// How often a surface winds around p, by the sum of its solid angles. A. Van Oosterom, J. Strackee:
// "The Solid Angle of a Plane Triangle" (1983).
double winding(const Mesh& mesh, const Vec3d& p) {
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d a = mesh.points[t[0]] - p, b = mesh.points[t[1]] - p, c = mesh.points[t[2]] - p;
        const double la = a.length(), lb = b.length(), lc = c.length();
        sum += 2 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4 * std::numbers::pi);
}

UnitedMesh united(const Mesh& mesh) {
    return uniteShells(closeMesh(mesh).mesh);
}

// The union winds once around what the shells wind around, and around nothing else.
void expectUnion(const Mesh& shells, const Mesh& result, unsigned seed) {
    EXPECT_TRUE(test::isClosed(result));
    openvdb::BBoxd box;
    for (const Vec3d& p : shells.points) box.expand(p);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.1, 1.1);
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3d p =
            box.min() + box.extents() * Vec3d(uniform(random), uniform(random), uniform(random));
        const double before = winding(shells, p);
        const double expected = before > 0.5 ? 1 : 0;
        EXPECT_NEAR(before, std::round(before), 1e-6);
        EXPECT_NEAR(winding(result, p), expected, 1e-6) << before;
        inside += expected > 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 0);
    EXPECT_LT(inside, 300);
}

Mesh moved(Mesh mesh, const Vec3d& angles, const Vec3d& by) {
    openvdb::Mat3d turn = openvdb::Mat3d::identity();
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d along(0.0);
        along[axis] = 1;
        turn = turn * openvdb::math::rotation<openvdb::Mat3d>(along, angles[axis]);
    }
    for (Vec3d& p : mesh.points) p = turn * p + by;
    return mesh;
}

TEST(UniteShells, CubesByTheirVolume) {
    struct Case {
        Vec3d corner;
        double side, volume;
    };
    const Case cases[] = {
        {Vec3d(0.5), 1, 1.875},              // a corner within
        {Vec3d(0.5, 0, 0), 1, 1.5},          // four pairs of faces cover each other
        {Vec3d(1, 0, 0), 1, 2},              // a face in common
        {Vec3d(1, 0.5, 0.25), 1, 2},         // part of a face
        {Vec3d(1, 1, 0), 1, 2},              // an edge
        {Vec3d(1, 1, 1), 1, 2},              // a corner
        {Vec3d(0.25), 0.5, 1},               // within
        {Vec3d(0.25, 0.25, 0.5), 0.5, 1},    // within, at a face
        {Vec3d(0, 0, 0), 0.5, 1},            // within, in a corner
        {Vec3d(0.25, 0.25, 1), 0.5, 1.125},  // upon a face
        {Vec3d(0.25, 0.25, -0.5), 2, 8.4375},
        {Vec3d(3), 1, 2},
    };
    for (const Case& c : cases) {
        Mesh mesh = test::cube(Vec3d(0.0), 1);
        test::append(mesh, test::cube(c.corner, c.side));
        const UnitedMesh result = united(mesh);
        EXPECT_TRUE(test::isClosed(result.mesh)) << c.corner;
        EXPECT_NEAR(test::volume(result.mesh), c.volume, 1e-12) << c.corner << " " << c.side;
    }
}

TEST(UniteShells, CavitiesStay) {
    struct Case {
        Vec3d corner;
        double volume;
    };
    for (const Case& c : {Case{Vec3d(0.25), 0.875}, Case{Vec3d(0.75, 0.25, 0.25), 0.9375},
                          Case{Vec3d(0.5, 0.25, 0.25), 0.875}}) {
        Mesh mesh = test::cube(Vec3d(0.0), 1);
        test::append(mesh, test::reversed(test::cube(c.corner, 0.5)));
        const UnitedMesh result = uniteShells(mesh);
        EXPECT_TRUE(test::isClosed(result.mesh)) << c.corner;
        EXPECT_NEAR(test::volume(result.mesh), c.volume, 1e-12) << c.corner;
    }
}

// Corners, edges and faces of cubes on a lattice meet in all possible ways.
TEST(UniteShells, CubesOnALatticeFillItsCells) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> place(0, 4), side(1, 3);
    for (int round = 0; round < 12; ++round) {
        Mesh mesh;
        std::set<std::array<int, 3>> cells;
        for (int i = 0; i < 12; ++i) {
            const std::array<int, 3> corner{place(random), place(random), place(random)};
            const int length = side(random);
            test::append(mesh, test::cube(Vec3d(corner[0], corner[1], corner[2]), length));
            for (int x = 0; x < length; ++x) {
                for (int y = 0; y < length; ++y) {
                    for (int z = 0; z < length; ++z) {
                        cells.insert({corner[0] + x, corner[1] + y, corner[2] + z});
                    }
                }
            }
        }
        // As they are, without what closeMesh does to faces in common.
        const UnitedMesh result = uniteShells(mesh);
        EXPECT_TRUE(test::isClosed(result.mesh)) << round;
        EXPECT_NEAR(test::volume(result.mesh), static_cast<double>(cells.size()), 1e-9) << round;
        EXPECT_TRUE(findMeetings(closeMesh(result.mesh).mesh, silentProgress()).empty()) << round;
    }
}

TEST(UniteShells, TurnedSolidsByTheirWindingNumber) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(0, 6), place(-0.6, 0.6);
    const auto somewhere = [&](const Mesh& mesh) {
        return moved(mesh, Vec3d(angle(random), angle(random), angle(random)),
                     Vec3d(place(random), place(random), place(random)));
    };
    for (unsigned round = 0; round < 10; ++round) {
        Mesh mesh;
        for (int i = 0; i < 4; ++i) {
            test::append(mesh, somewhere(test::cube(Vec3d(-0.5), 1)));
            test::append(mesh, somewhere(test::tetrahedron(Vec3d(-0.5), 1.5)));
            test::append(mesh, somewhere(test::sphere(Vec3d(0.0), 0.5, 8, 12)));
        }
        test::append(mesh, somewhere(test::reversed(test::cube(Vec3d(-0.2), 0.4))));
        expectUnion(mesh, uniteShells(mesh).mesh, round);
    }
}

// Without the arithmetic being exact, lines that nearly coincide would come apart.
TEST(UniteShells, NearlyCoincidentSolids) {
    for (const double by : {1e-3, 1e-7, 1e-10, 1e-13}) {
        Mesh mesh = test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 12, 16);
        test::append(mesh, moved(test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 12, 16),
                                 Vec3d(by, -by, 2 * by), Vec3d(by, by, -by)));
        const double one = test::volume(test::sphere(Vec3d(0.1, 0.2, 0.3), 1, 12, 16));
        const UnitedMesh result = uniteShells(mesh);
        EXPECT_TRUE(test::isClosed(result.mesh)) << by;
        EXPECT_NEAR(test::volume(result.mesh), one, 20 * by + 1e-9) << by;
        EXPECT_GE(test::volume(result.mesh), one - 1e-9) << by;
    }
}

// A surface that passes through itself: a tube around a curve that crosses its own way.
TEST(UniteShells, SurfacesThatPassThroughThemselves) {
    Mesh mesh;
    constexpr int kAlong = 96, kAround = 12;
    for (int i = 0; i < kAlong; ++i) {
        const double u = 2 * std::numbers::pi * i / kAlong;
        const Vec3d middle(std::sin(u), std::sin(2 * u), 0.1 * std::cos(u));
        const Vec3d along = Vec3d(std::cos(u), 2 * std::cos(2 * u), -0.1 * std::sin(u)).unit();
        const Vec3d side = along.cross(Vec3d(0, 0, 1)).unit(), up = side.cross(along);
        for (int j = 0; j < kAround; ++j) {
            const double v = 2 * std::numbers::pi * j / kAround;
            mesh.points.push_back(middle + 0.2 * (std::cos(v) * side + std::sin(v) * up));
        }
    }
    for (int i = 0; i < kAlong; ++i) {
        for (int j = 0; j < kAround; ++j) {
            const auto at = [](int a, int b) {
                return static_cast<unsigned>(a % kAlong * kAround + b % kAround);
            };
            mesh.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    }
    if (test::volume(mesh) < 0) mesh = test::reversed(mesh);
    const UnitedMesh result = uniteShells(mesh);
    EXPECT_GT(result.report.trianglesCut, 20u);
    EXPECT_LT(test::volume(result.mesh), test::volume(mesh) - 0.01);
    expectUnion(mesh, result.mesh, 1);
}

// Triangles without area are there only for their edges.
TEST(UniteShells, TrianglesWithoutAreaAreNoObstacle) {
    Mesh mesh = test::cube(Vec3d(0.0), 1);
    // Between the two halves of the face below, and an edge's middle that one side only has.
    mesh.points.push_back(Vec3d(0.5, 0, 0));
    const unsigned middle = 8;
    for (openvdb::Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            if (t[k] != 0 || t[(k + 1) % 3] != 1) continue;
            // Halve the one triangle that runs from 0 to 1.
            const unsigned apex = t[(k + 2) % 3];
            t = openvdb::Vec3I(0, middle, apex);
            mesh.triangles.emplace_back(middle, 1, apex);
            mesh.triangles.emplace_back(0, 1, middle);
            break;
        }
        if (mesh.triangles.size() > 12) break;
    }
    ASSERT_TRUE(test::isClosed(mesh));
    test::append(mesh, test::cube(Vec3d(0.75, -0.5, -0.5), 1));
    const UnitedMesh result = uniteShells(mesh);
    EXPECT_TRUE(test::isClosed(result.mesh));
    EXPECT_NEAR(test::volume(result.mesh), 2 - 0.25 * 0.25, 1e-12);
}

TEST(UniteShells, WhatDoesNotMeetComesBackAsItWas) {
    const Mesh sphere = test::sphere(Vec3d(0.0), 1, 20, 30);
    const UnitedMesh result = uniteShells(sphere);
    EXPECT_EQ(result.mesh.points, sphere.points);
    EXPECT_EQ(result.mesh.triangles, sphere.triangles);
    EXPECT_EQ(result.report.meetings, 0u);
    EXPECT_TRUE(result.report.warnings.empty());
}

TEST(UniteShells, ShellsThatCancelAreAnError) {
    Mesh mesh = test::cube(Vec3d(0.0), 1);
    test::append(mesh, test::reversed(test::cube(Vec3d(0.0), 1)));
    try {
        uniteShells(mesh);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Result);
    }
}

TEST(UniteShells, ThreadsChangeNothing) {
    Mesh mesh = test::sphere(Vec3d(0.0), 1, 20, 30);
    test::append(mesh, test::sphere(Vec3d(0.7, 0.1, 0.2), 1, 20, 30));
    std::vector<Mesh> results;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        results.push_back(uniteShells(mesh).mesh);
    }
    EXPECT_EQ(results[0].points, results[1].points);
    EXPECT_EQ(results[0].triangles, results[1].triangles);
}

}  // namespace
}  // namespace bandvox
