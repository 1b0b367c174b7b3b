// Joining of the ends of lines, in drawings of a few straight ones.

#include "outline/fills/weld_chains.h"

#include "outline/plain_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace bandvox::outline_test {
namespace {

// Ends nearer than 0.02 are one place; gaps up to 0.05 are bridged.
constexpr CurveSampling kPage{.flatness = 0.01, .size = 100};

std::vector<Curve> welded(const std::vector<Curve>& curves, int hidden = 0) {
    std::vector<VisiblePiece> pieces;
    for (const Curve& curve : curves) pieces.push_back({curve, hidden});
    return weldedCurves(pieces, PlainScene(), kPage);
}

void expectAt(const CurvePoint& p, double x, double y) {
    EXPECT_DOUBLE_EQ(p.x, x);
    EXPECT_DOUBLE_EQ(p.y, y);
}

TEST(WeldChains, GivesEndsThatAreNearOnePlace) {
    const auto curves =
        welded({chainOf({{0, 0, 0}, {10, 0, 0}}), chainOf({{10.01, 0.005, 0}, {20, 5, 0}}),
                chainOf({{20, 9, 0}, {9.995, -0.005, 0}})});
    ASSERT_EQ(curves.size(), 3U);
    expectAt(curves[1].points.front(), 10, 0);
    expectAt(curves[2].points.back(), 10, 0);
    for (const Curve& curve : curves) EXPECT_EQ(curve.points.size(), 2U);
}

TEST(WeldChains, PutsAPointWhereALinePassesAnEnd) {
    const auto curves = welded(
        {chainOf({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}), chainOf({{14, 0.01, 0}, {14, 8, 0}})});
    ASSERT_EQ(curves[0].points.size(), 4U);
    expectAt(curves[0].points[2], 14, 0.01);
    expectAt(curves[1].points[0], 14, 0.01);
}

TEST(WeldChains, BridgesGapsAndNoMore) {
    const Curve line = chainOf({{0, 0, 0}, {20, 0, 0}});
    const auto near = welded({line, chainOf({{14, 0.04, 0}, {14, 8, 0}})});
    ASSERT_EQ(near[1].points.size(), 4U);
    expectAt(near[1].points.front(), 14, 0);
    ASSERT_EQ(near[0].points.size(), 3U);
    expectAt(near[0].points[1], 14, 0);
    const auto far = welded({line, chainOf({{14, 0.06, 0}, {14, 8, 0}})});
    EXPECT_EQ(far[0].points.size(), 2U);
    EXPECT_EQ(far[1].points.size(), 2U);
}

TEST(WeldChains, DoesNotJoinALineToItsOwnEnd) {
    const auto curves = welded({chainOf({{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}, {20, 0, 0}})});
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(curves[0].points.size(), 4U);
}

TEST(WeldChains, LeavesHiddenAndSuggestiveLinesAway) {
    const std::vector<Curve> lines{chainOf({{0, 0, 0}, {10, 0, 0}})};
    EXPECT_TRUE(welded(lines, 1).empty());
    EXPECT_TRUE(welded({chainOf({{0, 0, 0}, {10, 0, 0}}, OutlineKind::Suggestive)}).empty());
}

}  // namespace
}  // namespace bandvox::outline_test
