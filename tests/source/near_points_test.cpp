#include "source/near_points.h"

#include <bandvox/core/parallel.h>

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// Points of a lattice, each moved by less than a tenth of its step: none is nearer than 0.8.
std::vector<Vec3d> lattice(int side, const Vec3d& origin) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> move(-0.1, 0.1);
    std::vector<Vec3d> points;
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < side; ++z) {
                points.push_back(origin +
                                 Vec3d(x + move(random), y + move(random), z + move(random)));
            }
        }
    }
    return points;
}

TEST(NearPoints, OneMoreIsFoundWhereverItIs) {
    std::vector<Vec3d> points = lattice(15, Vec3d(-15, 1000, 0));
    ASSERT_FALSE(haveNearPoints(points, 0.3));
    ASSERT_FALSE(haveNearPoints(points, 0));
    std::mt19937 random(9);
    std::uniform_real_distribution<double> move(-1, 1);
    points.emplace_back();
    for (std::size_t i = 0; i + 1 < points.size(); i += 97) {
        const Vec3d aside = Vec3d(move(random), move(random), move(random)).unit();
        points.back() = points[i] + 0.299 * aside;
        EXPECT_TRUE(haveNearPoints(points, 0.3)) << i;
        EXPECT_FALSE(haveNearPoints(points, 0.298)) << i;
        points.back() = points[i];
        EXPECT_TRUE(haveNearPoints(points, 0)) << i;
    }
}

TEST(NearPoints, AreFoundBySeveralThreads) {
    std::vector<Vec3d> points = lattice(60, Vec3d(0.0));
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        EXPECT_FALSE(haveNearPoints(points, 1e-3));
        points.push_back(points[123456] + Vec3d(0, 5e-4, 0));
        EXPECT_TRUE(haveNearPoints(points, 1e-3));
        EXPECT_FALSE(haveNearPoints(points, 1e-4));
        points.pop_back();
    }
}

TEST(NearPoints, OfFewPoints) {
    EXPECT_FALSE(haveNearPoints({}, 1));
    EXPECT_FALSE(haveNearPoints({Vec3d(0.0)}, 1));
    EXPECT_TRUE(haveNearPoints({Vec3d(0.0), Vec3d(0.0, -0.0, 0.0)}, 0));
    EXPECT_FALSE(haveNearPoints({Vec3d(0.0), Vec3d(1e-300, 0, 0)}, 0));
    EXPECT_TRUE(haveNearPoints({Vec3d(1e300), Vec3d(1e300)}, 0));
}

}  // namespace
}  // namespace bandvox
