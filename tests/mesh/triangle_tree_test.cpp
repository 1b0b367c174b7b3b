#include "mesh/triangle_tree.h"

#include "source/test_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;

TEST(NearestOnTriangle, IsTheNearestOfManyPoints) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto place = [&] { return Vec3d(number(random), number(random), number(random)); };
    for (int i = 0; i < 200; ++i) {
        TriangleCorners corners{place(), place(), place()};
        if (i % 10 == 0) corners[2] = corners[0];
        const Vec3d from = 1.5 * place();
        const NearestOnTriangle found = nearestOnTriangle(from, corners);
        EXPECT_NEAR((found.point - from).lengthSqr(), found.square, 1e-12);
        Vec3d weighed(0.0);
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(found.weights[k], 0);
            sum += found.weights[k];
            weighed += found.weights[k] * corners[static_cast<std::size_t>(k)];
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_NEAR((weighed - found.point).length(), 0, 1e-12);
        constexpr int kSteps = 50;
        for (int u = 0; u <= kSteps; ++u) {
            for (int v = 0; u + v <= kSteps; ++v) {
                const Vec3d other = corners[0] + (corners[1] - corners[0]) * (1.0 * u / kSteps) +
                                    (corners[2] - corners[0]) * (1.0 * v / kSteps);
                EXPECT_GE((other - from).lengthSqr(), found.square - 1e-12);
            }
        }
    }
}

TEST(TriangleTree, FindsWhatLookingAtAllFinds) {
    for (const int triangles : {1, 3, 5, 200}) {
        const Mesh mesh = test::soup(9, triangles);
        const TriangleTree tree(mesh);
        std::mt19937 random(4);
        std::uniform_real_distribution<double> number(-0.5, 1.5);
        for (int i = 0; i < 300; ++i) {
            const Vec3d place(number(random), number(random), number(random));
            NearestOnTriangle expected;
            std::uint32_t first = 0;
            for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
                const NearestOnTriangle here = nearestOnTriangle(place, cornersOf(mesh, k));
                if (!(here.square < expected.square)) continue;
                expected = here;
                first = k;
            }
            const NearestOnMesh found =
                tree.nearest(place, static_cast<std::uint32_t>(random() % 250));
            EXPECT_EQ(found.square, expected.square);
            EXPECT_EQ(found.triangle, first);
            EXPECT_EQ(found.point, expected.point);

            const double distance = std::sqrt(expected.square);
            const auto hint = static_cast<std::uint32_t>(random() % mesh.triangles.size());
            const auto within = tree.nearestWithin(place, 1.01 * distance);
            ASSERT_TRUE(within);
            EXPECT_EQ(within->triangle, first);
            const auto hinted = tree.nearestWithin(place, 10, hint);
            ASSERT_TRUE(hinted);
            EXPECT_EQ(hinted->triangle, first);
            EXPECT_FALSE(tree.nearestWithin(place, 0.99 * distance));
            EXPECT_FALSE(tree.nearestWithin(place, 0.99 * distance, hint));
        }
    }
}

TEST(TriangleTree, OfEqualTrianglesItFindsTheFirst) {
    Mesh mesh;
    mesh.points = {Vec3d(0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
    mesh.triangles.assign(50, openvdb::Vec3I(0, 1, 2));
    const TriangleTree tree(mesh);
    for (const std::uint32_t hint : {0U, 17U, 49U, 4000U}) {
        EXPECT_EQ(tree.nearest(Vec3d(0.2, 0.2, 3), hint).triangle, 0U);
    }
}

}  // namespace
}  // namespace bandvox
