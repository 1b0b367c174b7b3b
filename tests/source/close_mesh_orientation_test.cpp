// Which side of a piece is out: orientation within a piece, and pieces inside of others.
#include "source/test_meshes.h"

#include <bandvox/source/close_mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
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
using test::sphere;
using test::volume;

TEST(CloseMeshOrientation, MakesOrientationConsistent) {
    const Mesh mesh = sphere(Vec3d(0), 1.0, 20, 40);
    for (const double fraction : {0.01, 0.3, 0.7, 1.0}) {
        std::mt19937 random(11);
        Mesh mixed = mesh;
        std::size_t flipped = 0;
        for (Vec3I& t : mixed.triangles) {
            if (std::uniform_real_distribution<double>()(random) >= fraction) continue;
            std::swap(t[1], t[2]);
            ++flipped;
        }
        const ClosedMesh closed = closeMesh(mixed);
        EXPECT_TRUE(isClosed(closed.mesh));
        EXPECT_NEAR(volume(closed.mesh), volume(mesh), 1e-12);
        EXPECT_TRUE(closed.report.holes.empty());
        EXPECT_EQ(closed.report.components, 1u);
        EXPECT_EQ(closed.report.componentsTurned, fraction > 0.5 ? 1u : 0u);
        const std::size_t all = mesh.triangles.size();
        EXPECT_EQ(closed.report.trianglesFlipped, fraction < 0.5 ? flipped : all - flipped + all);
    }
}

TEST(CloseMeshOrientation, TurnsPiecesOutwardAndKeepsCavities) {
    const Mesh outer = cube(Vec3d(0), 10.0);
    const Mesh cavity = reversed(cube(Vec3d(2), 5.0));
    const Mesh core = cube(Vec3d(3), 2.0);
    Mesh solid;
    append(solid, core);
    append(solid, cavity);
    append(solid, outer);
    const double expected = 1000.0 - 125.0 + 8.0;

    ClosedMesh closed = closeMesh(solid);
    EXPECT_DOUBLE_EQ(volume(closed.mesh), expected);
    EXPECT_EQ(closed.report.components, 3u);
    EXPECT_EQ(closed.report.componentsTurned, 0u);
    EXPECT_TRUE(closed.report.warnings.empty());

    // All inside out: all are turned, and the cavity stays one.
    closed = closeMesh(reversed(solid));
    EXPECT_DOUBLE_EQ(volume(closed.mesh), expected);
    EXPECT_EQ(closed.report.componentsTurned, 3u);
    EXPECT_TRUE(hasWarning(closed.report, "3 pieces were inside out"));

    // Apart from the cavity, a disjoint piece that is inside out.
    append(solid, reversed(cube(Vec3d(20, 0, 0), 1.0)));
    closed = closeMesh(solid);
    EXPECT_DOUBLE_EQ(volume(closed.mesh), expected + 1.0);
    EXPECT_EQ(closed.report.componentsTurned, 1u);
    EXPECT_EQ(closed.report.trianglesFlipped, 12u);
}

TEST(CloseMeshOrientation, DoesNotTakeABoxForAContainer) {
    // A small inside-out cube in a corner of a ball's box.
    Mesh mesh;
    append(mesh, sphere(Vec3d(0), 10.0, 24, 48));
    append(mesh, reversed(cube(Vec3d(8), 1.0)));
    const double ball = volume(sphere(Vec3d(0), 10.0, 24, 48));
    ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.report.componentsTurned, 1u);
    EXPECT_NEAR(volume(closed.mesh), ball + 1.0, 1e-9);
}

TEST(CloseMeshOrientation, FindsContainersOnRaysThroughEdgesAndCorners) {
    // The middle of the largest triangle of each inner piece lies straight behind an edge or a
    // corner of the outer one.
    Mesh outer;
    constexpr int kSide = 6;
    const auto at = [](int i, int j) { return Vec3d(0, i, j); };
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            // Two plates of small triangles.
            for (const double x : {0.0, 6.0}) {
                const auto first = static_cast<unsigned>(outer.points.size());
                for (const Vec3d& p : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}) {
                    outer.points.push_back(p + Vec3d(x, 0, 0));
                }
                Mesh plate;
                plate.triangles = {Vec3I(first, first + 1, first + 2),
                                   Vec3I(first, first + 2, first + 3)};
                if (x == 0.0) plate = reversed(plate);
                outer.triangles.insert(outer.triangles.end(), plate.triangles.begin(),
                                       plate.triangles.end());
            }
        }
    }
    outer = closeMesh([&outer] {
                Mesh block = outer;
                for (int k = 0; k < kSide; ++k) {
                    for (const double end : {0.0, 6.0}) {
                        // Side walls along y and z.
                        Mesh wall;
                        wall.points = {Vec3d(0, k, end),     Vec3d(6, k, end), Vec3d(6, k + 1, end),
                                       Vec3d(0, k + 1, end), Vec3d(0, end, k), Vec3d(0, end, k + 1),
                                       Vec3d(6, end, k + 1), Vec3d(6, end, k)};
                        wall.triangles = {Vec3I(0, 1, 2), Vec3I(0, 2, 3), Vec3I(4, 5, 6),
                                          Vec3I(4, 6, 7)};
                        append(block, wall);
                    }
                }
                return block;
            }())
                .mesh;
    ASSERT_TRUE(isClosed(outer));
    ASSERT_NEAR(volume(outer), 216.0, 1e-12);
    for (const Vec3d& corner : {Vec3d(1, 1, 1), Vec3d(2, 2.5, 3), Vec3d(3, 1.5, 2.5)}) {
        // The middle of the slanted face lies half a unit from the corner along each axis.
        Mesh mesh = outer;
        append(mesh, reversed(test::tetrahedron(corner, 1.5)));
        EXPECT_NEAR(volume(closeMesh(mesh).mesh), 216.0 - 1.5 * 1.5 * 1.5 / 6.0, 1e-12);
    }
}

TEST(CloseMeshOrientation, HandlesManyPieces) {
    Mesh mesh;
    std::mt19937 random(2);
    constexpr int kPieces = 10000;
    std::size_t reversedPieces = 0;
    for (int i = 0; i < kPieces; ++i) {
        const Vec3d corner(i % 22, i / 22 % 22, i / 484);
        const bool turn = random() % 3 == 0;
        const Mesh piece = test::tetrahedron(corner * 1.1, 1.0);
        append(mesh, turn ? reversed(piece) : piece);
        reversedPieces += turn ? 1 : 0;
    }
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_EQ(closed.report.components, static_cast<std::size_t>(kPieces));
    EXPECT_EQ(closed.report.componentsTurned, reversedPieces);
    EXPECT_NEAR(volume(closed.mesh), kPieces / 6.0, 1e-6);
}

TEST(CloseMeshOrientation, ClosesAMoebiusStripAndSaysSo) {
    Mesh mesh;
    constexpr unsigned kSteps = 24;
    for (unsigned i = 0; i < kSteps; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kSteps;
        const Vec3d out(std::cos(angle), 0, std::sin(angle));
        const Vec3d across = std::cos(angle / 2) * out + Vec3d(0, std::sin(angle / 2), 0);
        mesh.points.push_back(out - 0.3 * across);
        mesh.points.push_back(out + 0.3 * across);
    }
    for (unsigned i = 0; i < kSteps; ++i) {
        const unsigned a = 2 * i;
        const unsigned b = 2 * i + 1;
        const bool last = i + 1 == kSteps;
        const unsigned c = last ? 1 : 2 * i + 2;
        const unsigned d = last ? 0 : 2 * i + 3;
        mesh.triangles.emplace_back(a, c, d);
        mesh.triangles.emplace_back(a, d, b);
    }
    append(mesh, cube(Vec3d(5), 1.0));
    const ClosedMesh closed = closeMesh(mesh);
    EXPECT_TRUE(isClosed(closed.mesh));
    EXPECT_TRUE(hasWarning(closed.report, "one-sided"));
}

}  // namespace
}  // namespace bandvox
