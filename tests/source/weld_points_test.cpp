#include "source/weld_points.h"

#include "source/test_meshes.h"

#include <gtest/gtest.h>

#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;

/// Each point alone in a triangle, so that none is unused.
Mesh meshOf(const std::vector<Vec3d>& points) {
    Mesh mesh;
    mesh.points = points;
    for (unsigned i = 0; i < points.size(); ++i) mesh.triangles.emplace_back(i, i, i);
    return mesh;
}

/// The first earlier representative within the tolerance, by looking at all.
std::vector<Vec3d> slowWeld(const std::vector<Vec3d>& points, double tolerance) {
    std::vector<Vec3d> unique;
    for (const Vec3d& p : points) {
        const bool known = std::any_of(unique.begin(), unique.end(), [&](const Vec3d& q) {
            return (p - q).length() <= tolerance;
        });
        if (!known) unique.push_back(p);
    }
    return unique;
}

TEST(WeldPoints, AgreesWithASlowSearch) {
    std::mt19937 random(1);
    for (const double tolerance : {0.0, 1e-9, 0.01, 0.05, 0.4}) {
        std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
        std::vector<Vec3d> points;
        for (int i = 0; i < 2000; ++i) {
            points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
            if (i % 5 == 0) points.push_back(points[random() % points.size()]);
            if (i % 7 == 0) {
                points.push_back(points[random() % points.size()] + Vec3d(0.9 * tolerance, 0, 0));
            }
        }
        const std::vector<Vec3d> expected = slowWeld(points, tolerance);
        Mesh mesh = meshOf(points);
        EXPECT_EQ(weldPoints(mesh, tolerance), points.size() - expected.size());
        EXPECT_EQ(mesh.points, expected) << tolerance;
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_LE((mesh.points[mesh.triangles[i][0]] - points[i]).length(), tolerance);
        }
    }
}

TEST(WeldPoints, ZerosOfEitherSignAreEqual) {
    Mesh mesh = meshOf({Vec3d(0.0, 0.0, 1.0), Vec3d(-0.0, 0.0, 1.0)});
    EXPECT_EQ(weldPoints(mesh, 0.0), 1u);
    EXPECT_EQ(mesh.triangles[1], Vec3I(0, 0, 0));
}

TEST(WeldPoints, TakesNothingAndTolerancesBelowRounding) {
    Mesh mesh;
    EXPECT_EQ(weldPoints(mesh, 1.0), 0u);
    mesh = meshOf({Vec3d(1e30), Vec3d(2e30), Vec3d(1e30)});
    EXPECT_EQ(weldPoints(mesh, 1e-30), 1u);
}

}  // namespace
}  // namespace bandvox
