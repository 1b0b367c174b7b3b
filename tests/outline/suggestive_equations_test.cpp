// Suggestive contours against the closed form of a torus' curvature.

#include "outline/volumes/suggestive_equations.h"

#include "outline/volume_shapes.h"
#include "outline/volume_views.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bandvox::outline_test {
namespace {

using openvdb::Vec3d;

// A torus about z whose tube is thick enough for a lattice of 64.
constexpr double kRing = 0.6, kTube = 0.3;

double ringDistance(const Vec3d& p) {
    return std::hypot(std::hypot(p[0], p[1]) - kRing, p[2]) - kTube;
}

// The curvature of the torus in the direction of w, and w, at a place near it.
double curvatureTowards(const Vec3d& p, const Vec3d& eye, Vec3d& w) {
    const double r = std::hypot(p[0], p[1]);
    const Vec3d radial(p[0] / r, p[1] / r, 0), around(-p[1] / r, p[0] / r, 0);
    const Vec3d normal = (radial * (r - kRing) + Vec3d(0, 0, p[2])).unit();
    w = eye - normal.dot(eye) * normal;
    const double alongRing = w.dot(around) / w.length();
    const double cosine = normal.dot(radial);
    const double square = alongRing * alongRing;
    return (1 - square) / kTube + square * cosine / (kRing + kTube * cosine);
}

Vec3d ontoTorus(const Vec3d& p) {
    const double r = std::hypot(p[0], p[1]);
    const Vec3d middle(kRing * p[0] / r, kRing * p[1] / r, 0);
    return middle + kTube * (p - middle).unit();
}

TEST(SuggestiveEquations, FollowTheTorusCurvature) {
    for (const auto& lattice : {plainLattice(), turnedLattice()}) {
        const auto grid = levelSet(ringDistance, lattice);
        OutlineOptions options = fixedView(Vec3d(0.2, -1, 0.55), false);
        options.suggestive = 0.5;
        const VolumeLines lines = linesOf({{grid, {}, "torus"}}, options);
        const Vec3d eye = Vec3d(0.2, -1, 0.55).unit();
        int points = 0, falling = 0;
        for (const Curve& curve : lines.drawing->curves()) {
            if (curve.kind != OutlineKind::Suggestive) continue;
            for (const CurvePoint& point : curve.points) {
                const Vec3d p = grid->indexToWorld(Vec3d(point.u, point.v, point.s));
                EXPECT_NEAR(ringDistance(p), 0, 2e-4);
                Vec3d w;
                EXPECT_NEAR(curvatureTowards(p, eye, w), 0, 0.02 / kTube);
                // It grows towards the eye.
                Vec3d other;
                constexpr double kStep = 0.02;
                const Vec3d ahead = ontoTorus(p + kStep * w.unit());
                const Vec3d behind = ontoTorus(p - kStep * w.unit());
                const bool grows =
                    curvatureTowards(ahead, eye, other) > curvatureTowards(behind, eye, other);
                falling += grows ? 0 : 1;
                ++points;
            }
        }
        EXPECT_GT(points, 50);
        // Third derivatives of the spline between the nodes jump from voxel to voxel.
        EXPECT_LT(falling, points / 20) << points;
    }
}

TEST(SuggestiveEquations, AreNoneOfABall) {
    const auto grid =
        levelSet([](const Vec3d& p) { return ballDistance(p, Vec3d(0.0), 0.8); }, plainLattice());
    OutlineOptions options = fixedView(Vec3d(0.2, -1, 0.4), true);
    options.suggestive = 0;
    const VolumeLines lines = linesOf({{grid, {}, "ball"}}, options);
    for (const Curve& curve : lines.drawing->curves()) {
        EXPECT_EQ(curve.kind, OutlineKind::Contour);
    }
}

TEST(SuggestiveEquations, GrowFewerWithTheStrength) {
    const auto grid = levelSet(ringDistance, plainLattice());
    OutlineOptions options = fixedView(Vec3d(0.2, -1, 0.55), false);
    std::size_t before = 1000000;
    for (const double strength : {0.0, 1.0, 1000.0}) {
        options.suggestive = strength;
        const VolumeLines lines = linesOf({{grid, {}, "torus"}}, options);
        std::size_t points = 0;
        for (const Curve& curve : lines.drawing->curves()) {
            points += curve.kind == OutlineKind::Suggestive ? curve.points.size() : 0;
        }
        EXPECT_LE(points, before);
        before = points;
    }
    EXPECT_EQ(before, 0U);
}

}  // namespace
}  // namespace bandvox::outline_test
