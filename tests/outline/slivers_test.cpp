// What has no width on the page is left away, and nothing else.

#include "outline/drawing/slivers.h"

#include "outline/plain_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace bandvox::outline_test {
namespace {

constexpr double kWidth = 0.01;

Curve ellipse(double a, double b) {
    std::vector<std::array<double, 3>> places;
    constexpr int kPoints = 64;
    for (int k = 0; k <= kPoints; ++k) {
        const double t = 2 * std::numbers::pi * (k % kPoints) / kPoints;
        places.push_back({a * std::cos(t), b * std::sin(t), 0});
    }
    return chainOf(places);
}

double lengthOf(const Curve& curve) {
    double length = 0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        length += std::hypot(curve.points[i].x - curve.points[i - 1].x,
                             curve.points[i].y - curve.points[i - 1].y);
    }
    return length;
}

TEST(Slivers, AreClosedCurvesThatGoThereAndBack) {
    const auto kept =
        withoutSlivers({ellipse(10, 0.004), ellipse(10, 0.02), ellipse(1, 1)}, kWidth);
    ASSERT_EQ(kept.size(), 2U);
    EXPECT_GT(lengthOf(kept[0]), 39);
    EXPECT_LT(lengthOf(kept[1]), 7);
}

TEST(Slivers, AreNoOpenCurves) {
    const Curve line = chainOf({{0, 0, 0}, {10, 0, 0}});
    const auto kept = withoutSlivers({line}, kWidth);
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_EQ(kept[0].points.size(), 2U);
}

TEST(Slivers, PartsThatGoBackAreTakenOut) {
    Curve line = chainOf({{0, 0, 0}, {6, 0, 0}, {4, 0.002, 0}, {10, 0, 0}});
    line.points[1].corner = line.points[2].corner = true;
    const auto kept = withoutSlivers({line}, kWidth);
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_NEAR(lengthOf(kept[0]), 10, 1e-4);
    for (const CurvePoint& p : kept[0].points) EXPECT_FALSE(p.corner);
}

TEST(Slivers, SwallowtailsThatCanBeSeenStay) {
    Curve line = chainOf({{0, 0, 0}, {6, 0, 0}, {4, 0.5, 0}, {10, 1, 0}});
    line.points[1].corner = line.points[2].corner = true;
    const auto kept = withoutSlivers({line}, kWidth);
    ASSERT_EQ(kept.size(), 1U);
    EXPECT_EQ(kept[0].points.size(), 4U);
}

}  // namespace
}  // namespace bandvox::outline_test
