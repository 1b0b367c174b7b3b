#include "compare/test_surfaces.h"
#include "mesh/triangle_tree.h"
#include "source/test_meshes.h"

#include <bandvox/compare/compare_surfaces.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox::compare_test {
namespace {

using openvdb::Vec3d;

constexpr double kDegrees = 180 / 3.14159265358979323846;

SurfaceDifference compare(const Mesh& a, const Mesh& b, double tolerance = 1e-4) {
    return compareSurfaces({.mesh = a}, {.mesh = b}, {.tolerance = tolerance});
}

// What is promised of any result.
void expectBounds(const SurfaceDifference& found, double tolerance) {
    for (const OneSidedDistance& side : {found.fromA, found.fromB}) {
        EXPECT_LE(side.maximum, side.atMost);
        EXPECT_LE(side.atMost, side.maximum + tolerance + 1e-12);
        EXPECT_LE(side.mean, side.rms + 1e-12);
        EXPECT_LE(side.rms, side.maximum + 1e-12);
        EXPECT_NEAR((side.at - side.nearest).length(), side.maximum, 1e-9);
    }
    EXPECT_EQ(found.hausdorff, std::max(found.fromA.maximum, found.fromB.maximum));
}

void expectSameBits(const OneSidedDistance& a, const OneSidedDistance& b) {
    EXPECT_EQ(a.maximum, b.maximum);
    EXPECT_EQ(a.atMost, b.atMost);
    EXPECT_EQ(a.at, b.at);
    EXPECT_EQ(a.nearest, b.nearest);
    EXPECT_EQ(a.mean, b.mean);
    EXPECT_EQ(a.rms, b.rms);
    EXPECT_EQ(a.area, b.area);
}

TEST(CompareSurfaces, OneInsideTheOther) {
    // The sag of the triangles is 8e-4 at most.
    const SurfaceDifference found = compare(sphere(Vec3d(0), 1, 40), sphere(Vec3d(0), 1.25, 40));
    expectBounds(found, 1e-4);
    EXPECT_NEAR(found.hausdorff, 0.25, 1.5e-3);
    EXPECT_NEAR(found.meanDistance, 0.25, 1e-3);
    EXPECT_NEAR(found.fromA.area, 4 / kDegrees * 180, 0.02);
    EXPECT_LT(found.angles.maximum, 3);
}

TEST(CompareSurfaces, ShiftedSpheres) {
    const double radius = 1, shift = 0.3;
    const SurfaceDifference found =
        compare(sphere(Vec3d(0), radius, 64), sphere(Vec3d(shift, 0, 0), radius, 64));
    expectBounds(found, 1e-4);
    EXPECT_NEAR(found.hausdorff, shift, 5e-4);
    // |x - c| - r on the first sphere is √w - r, w = r² + s² - 2 r s u, and u = cos θ is evenly
    // distributed; ∫ √w du = -w^1.5 / (3 r s).
    const auto integral = [&](double low, double high) {
        const auto at = [&](double u) {
            return -std::pow(radius * radius + shift * shift - 2 * radius * shift * u, 1.5) /
                       (3 * radius * shift) -
                   radius * u;
        };
        return at(high) - at(low);
    };
    const double turn = shift / (2 * radius);
    const double mean = (integral(-1, turn) - integral(turn, 1)) / 2;
    EXPECT_NEAR(found.fromA.mean, mean, 3e-4);
    EXPECT_NEAR(found.fromB.mean, mean, 3e-4);
    EXPECT_NEAR(found.angles.maximum, std::asin(shift / radius) * kDegrees, 1.5);
}

TEST(CompareSurfaces, RoundedCube) {
    const double radius = 0.5;
    const SurfaceDifference found = compare(roundedCube(0, 4), roundedCube(radius, 64));
    expectBounds(found, 1e-4);
    EXPECT_NEAR(found.fromA.maximum, radius * (std::sqrt(3.0) - 1), 3e-4);
    EXPECT_NEAR(found.fromB.maximum, radius * (1 - 1 / std::sqrt(3.0)), 3e-4);
    EXPECT_NEAR(found.fromA.at.length(), std::sqrt(3.0), 1e-9);
}

TEST(CompareSurfaces, Tori) {
    const SurfaceDifference found = compare(torus(2, 0.5, 160), torus(2, 0.6, 160));
    expectBounds(found, 1e-4);
    EXPECT_NEAR(found.hausdorff, 0.1, 2e-3);
    EXPECT_NEAR(found.meanDistance, 0.1, 1e-3);
}

TEST(CompareSurfaces, MissingPartIsSeenFromOneSide) {
    const Mesh one = sphere(Vec3d(0), 1, 24);
    const SurfaceDifference found = compare(joined(one, sphere(Vec3d(5, 0, 0), 1, 24)), one);
    expectBounds(found, 1e-4);
    EXPECT_NEAR(found.fromA.maximum, 5, 5e-3);
    EXPECT_LT(found.fromB.maximum, 1e-12);
    EXPECT_LT(found.fromB.mean, 1e-12);
    EXPECT_NEAR(found.fromA.at[0], 6, 0.05);
}

TEST(CompareSurfaces, LargestDistanceInsideATriangle) {
    // A large triangle above a ring: its middle is the farthest, its corners lie on the ring.
    Mesh plate, corners;
    plate.points = {Vec3d(0), Vec3d(3, 0, 0), Vec3d(0, 4, 0)};
    plate.triangles = {{0, 1, 2}};
    for (int k = 0; k < 3; ++k) {
        const Vec3d a = plate.points[k], b = plate.points[(k + 1) % 3];
        corners.points.insert(corners.points.end(), {a, b});
        const auto first = static_cast<unsigned>(2 * k);
        corners.triangles.emplace_back(first, first + 1, first);
    }
    const SurfaceDifference found = compare(plate, corners, 1e-6);
    expectBounds(found, 1e-6);
    // The middle of the circle that touches all sides, radius (3 + 4 - 5) / 2.
    EXPECT_NEAR(found.hausdorff, 1, 1e-6);
    EXPECT_NEAR((found.fromA.at - Vec3d(1, 1, 0)).length(), 0, 2e-3);
}

TEST(CompareSurfaces, AgreesWithLookingEverywhere) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const Mesh a = test::soup(seed, 40), b = test::soup(seed + 100, 25);
        const double tolerance = 1e-3;
        const SurfaceDifference found = compare(a, b, tolerance);
        expectBounds(found, tolerance);
        constexpr int kSteps = 40;
        double largest = 0;
        for (std::size_t i = 0; i < a.triangles.size(); ++i) {
            const TriangleCorners c = cornersOf(a, i);
            for (int u = 0; u <= kSteps; ++u) {
                for (int v = 0; u + v <= kSteps; ++v) {
                    const Vec3d place = c[0] + (c[1] - c[0]) * (1.0 * u / kSteps) +
                                        (c[2] - c[0]) * (1.0 * v / kSteps);
                    double nearest = std::numeric_limits<double>::max();
                    for (std::size_t j = 0; j < b.triangles.size(); ++j) {
                        nearest =
                            std::min(nearest, nearestOnTriangle(place, cornersOf(b, j)).square);
                    }
                    largest = std::max(largest, std::sqrt(nearest));
                }
            }
        }
        EXPECT_LE(largest, found.fromA.atMost + 1e-12);
        // Between the places that were looked at it rises by no more than their distance.
        EXPECT_GE(largest, found.fromA.maximum - 0.3 * std::sqrt(3.0) / kSteps);
    }
}

TEST(CompareSurfaces, IdenticalSurfacesAreNoDistanceApart) {
    for (const Mesh& mesh : {sphere(Vec3d(7, 8, 9), 2, 20), torus(2, 0.5, 40), test::soup(5, 30)}) {
        const SurfaceDifference found = compare(mesh, mesh);
        expectBounds(found, 1e-4);
        EXPECT_LT(found.hausdorff, 1e-12);
        EXPECT_LT(found.hausdorffAtMost, 1e-12);
        EXPECT_LT(found.meanDistance, 1e-12);
    }
    const Mesh mesh = torus(2, 0.5, 40);
    EXPECT_LT(compare(mesh, mesh).angles.maximum, 1e-5);
}

TEST(CompareSurfaces, ExchangingTheTwoExchangesTheResults) {
    const Mesh a = roundedCube(0.4, 12), b = sphere(Vec3d(0.1, 0, 0), 1.1, 14);
    const SurfaceDifference one = compare(a, b), other = compare(b, a);
    expectSameBits(one.fromA, other.fromB);
    expectSameBits(one.fromB, other.fromA);
    EXPECT_EQ(one.hausdorff, other.hausdorff);
    EXPECT_EQ(one.hausdorffAtMost, other.hausdorffAtMost);
    EXPECT_EQ(one.meanDistance, other.meanDistance);
    EXPECT_EQ(one.angles.mean, other.angles.mean);
    EXPECT_EQ(one.angles.percent95, other.angles.percent95);
    EXPECT_EQ(one.angles.maximum, other.angles.maximum);
}

TEST(CompareSurfaces, IsTheSameForAnyNumberOfThreads) {
    const Mesh a = roundedCube(0.4, 30), b = sphere(Vec3d(0.1, 0, 0), 1.1, 33);
    SurfaceDifference results[2];
    for (int i = 0; i < 2; ++i) {
        const ThreadLimit limit(i == 0 ? 1 : 4);
        results[i] = compare(a, b, 1e-5);
    }
    expectSameBits(results[0].fromA, results[1].fromA);
    expectSameBits(results[0].fromB, results[1].fromB);
    EXPECT_EQ(results[0].angles.mean, results[1].angles.mean);
}

TEST(CompareSurfaces, NormalsOfPointsAreUsed) {
    ComparedSurface a{.mesh = torus(2, 0.5, 24)}, b = a;
    b.normals.assign(b.mesh.points.size(), openvdb::Vec3f(0, 0, 1));
    const SurfaceDifference found = compareSurfaces(a, b, {.tolerance = 1e-3});
    // Against a fixed direction the torus has normals of every angle.
    EXPECT_NEAR(found.angles.mean, 90, 1);
    EXPECT_GT(found.angles.maximum, 170);
    EXPECT_NEAR(found.angles.percent95, 165, 8);
    EXPECT_LT(found.hausdorff, 1e-12);
}

TEST(CompareSurfaces, ABoundThatCannotBeProvenIsWider) {
    const ComparedSurface a{.mesh = sphere(Vec3d(0), 1, 8)};
    const ComparedSurface b{.mesh = sphere(Vec3d(0), 1, 7), .deviation = 0.25};
    const SurfaceDifference quick = compareSurfaces(a, b, {.tolerance = 1e-6, .mostPieces = 0});
    const SurfaceDifference slow = compareSurfaces(a, b, {.tolerance = 1e-3});
    EXPECT_GT(quick.fromA.atMost, quick.fromA.maximum + 1e-2);
    EXPECT_GE(quick.fromA.atMost, slow.fromA.maximum);
    EXPECT_LE(quick.fromA.maximum, slow.fromA.maximum);
    EXPECT_DOUBLE_EQ(slow.hausdorffAtMost, std::max(slow.fromA.atMost, slow.fromB.atMost) + 0.25);
}

TEST(CompareSurfaces, RefusesWhatItCannotCompare) {
    const ComparedSurface good{.mesh = sphere(Vec3d(0), 1, 3)};
    const auto kindOf = [&good](const ComparedSurface& bad, double tolerance) {
        try {
            compareSurfaces(good, bad, {.tolerance = tolerance});
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Interrupted;
    };
    EXPECT_EQ(kindOf(good, 0), ErrorKind::Interrupted) << "this one works";
    EXPECT_EQ(kindOf({}, 0), ErrorKind::Input);
    EXPECT_EQ(kindOf(good, -1), ErrorKind::Usage);
    EXPECT_EQ(kindOf(good, std::nan("")), ErrorKind::Usage);
    ComparedSurface bad = good;
    bad.mesh.triangles[0][1] = 100000;
    EXPECT_EQ(kindOf(bad, 0), ErrorKind::Input);
    bad = good;
    bad.mesh.points[3][1] = std::nan("");
    EXPECT_EQ(kindOf(bad, 0), ErrorKind::Input);
    bad = good;
    bad.normals.resize(3);
    EXPECT_EQ(kindOf(bad, 0), ErrorKind::Usage);
    bad = good;
    bad.deviation = -1;
    EXPECT_EQ(kindOf(bad, 0), ErrorKind::Usage);
}

}  // namespace
}  // namespace bandvox::compare_test
