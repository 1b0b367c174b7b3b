#include "mesh/nearest_triangle.h"

#include "source/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;

TEST(NearestTriangle, FindsWhatASlowSearchFinds) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const auto place = [&] {
        return Vec3d(coordinate(random), coordinate(random), coordinate(random));
    };
    for (const int count : {1, 7, 400}) {
        Mesh mesh;
        for (int i = 0; i < count; ++i) {
            const Vec3d center = place();
            for (int k = 0; k < 3; ++k) mesh.points.push_back(center + 0.2 * place());
            const auto first = static_cast<std::uint32_t>(3 * i);
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        const NearestTriangle nearest(mesh);
        for (int trial = 0; trial < 300; ++trial) {
            const Vec3d p = 1.5 * place();
            double least = std::numeric_limits<double>::infinity();
            for (const openvdb::Vec3I& t : mesh.triangles) {
                least = std::min(least, distanceToTriangle(p, {mesh.points[t[0]], mesh.points[t[1]],
                                                               mesh.points[t[2]]}));
            }
            const auto found = nearest.find(p, 10);
            ASSERT_TRUE(found);
            EXPECT_NEAR(std::sqrt(found->squaredDistance), least, 1e-12);
            EXPECT_NEAR((found->place - p).length(), least, 1e-12);
            EXPECT_FALSE(nearest.find(p, 0.99 * least));
            EXPECT_TRUE(nearest.find(p, 1.01 * least));
            const auto guess = static_cast<std::uint32_t>(trial % count);
            const auto guessed = nearest.find(p, 10, guess);
            ASSERT_TRUE(guessed);
            EXPECT_EQ(guessed->triangle, found->triangle);
        }
    }
}

TEST(NearestTriangle, TakesTheFirstOfSeveralWhateverTheGuess) {
    const Mesh mesh{{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)},
                    {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};
    const NearestTriangle nearest(mesh);
    for (const std::uint32_t guess : {0U, 1U, 2U}) {
        EXPECT_EQ(nearest.find({0.2, 0.2, 1}, 1, guess)->triangle, 0U) << "at the very distance";
    }
    EXPECT_FALSE(NearestTriangle(Mesh()).find({0, 0, 0}, 10));
}

}  // namespace
}  // namespace bandvox
