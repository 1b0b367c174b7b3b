// How segments divide the plane, against what is known of it.

#include "outline/fills/planar_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

namespace bandvox {
namespace {

double areaOf(const PlanarMap& map, std::int32_t face) {
    double area = 0;
    for (const PlanarMap::HalfEdge& half : map.halves) {
        if (half.face != face) continue;
        const auto& a = half.start;
        const auto& b = map.halves[static_cast<std::size_t>(half.twin)].start;
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    return area;
}

// Each half's follower starts where it ends, and both bound one face.
void expectConsistent(const PlanarMap& map) {
    for (std::size_t h = 0; h < map.halves.size(); ++h) {
        const PlanarMap::HalfEdge& half = map.halves[h];
        const auto& twin = map.halves[static_cast<std::size_t>(half.twin)];
        const auto& next = map.halves[static_cast<std::size_t>(half.next)];
        EXPECT_EQ(static_cast<std::size_t>(twin.twin), h);
        EXPECT_EQ(next.origin, twin.origin);
        EXPECT_EQ(next.start, twin.start);
        EXPECT_EQ(next.face, half.face);
        EXPECT_NE(half.isForward, twin.isForward);
        EXPECT_EQ(half.segment, twin.segment);
    }
}

TEST(PlanarMap, HasTheFacesOfSquaresThatOverlap) {
    const std::vector<PlanarChain> chains{{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}},
                                          {{1, 1}, {3, 1}, {3, 3}, {1, 3}, {1, 1}}};
    const PlanarMap map = planarMap(chains);
    expectConsistent(map);
    EXPECT_EQ(map.vertices, 10);
    EXPECT_EQ(map.faces, 4);
    std::multiset<double> areas;
    for (std::int32_t f = 0; f < map.faces; ++f) areas.insert(areaOf(map, f));
    EXPECT_EQ(areas, (std::multiset<double>{-7, 1, 3, 3}));
    EXPECT_EQ(areaOf(map, map.outside), -7);
}

TEST(PlanarMap, TakesChainsThatLieOnEachOtherForOne) {
    const std::vector<PlanarChain> chains{{{0, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 0}},
                                          {{1, 0}, {3, 0}}};
    const PlanarMap map = planarMap(chains);
    expectConsistent(map);
    EXPECT_EQ(map.vertices, 5);
    EXPECT_EQ(map.faces, 2);
    for (const PlanarMap::HalfEdge& half : map.halves) EXPECT_EQ(half.chain, 0);
}

TEST(PlanarMap, KeepsHolesAndLooseLines) {
    const std::vector<PlanarChain> chains{{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}},
                                          {{2, 2}, {4, 2}, {4, 4}, {2, 2}},
                                          {{1, 5}, {2, 5}}};
    const PlanarMap map = planarMap(chains);
    expectConsistent(map);
    EXPECT_EQ(map.faces, 3);
    std::multiset<double> areas;
    for (std::int32_t f = 0; f < map.faces; ++f) areas.insert(areaOf(map, f));
    EXPECT_EQ(areas, (std::multiset<double>{-36, 2, 34}));
}

TEST(PlanarMap, FollowsEulersRuleForLinesAcrossACircle) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
    PlanarChain circle;
    constexpr int kSides = 97;
    for (int k = 0; k <= kSides; ++k) {
        const double a = 2 * std::numbers::pi * (k % kSides) / kSides;
        circle.push_back({std::cos(a), std::sin(a)});
    }
    std::vector<PlanarChain> chains{circle};
    constexpr int kLines = 40;
    for (int k = 0; k < kLines; ++k) {
        const double a = angle(random), b = angle(random);
        chains.push_back({{2 * std::cos(a), 2 * std::sin(a)}, {2 * std::cos(b), 2 * std::sin(b)}});
    }
    const PlanarMap map = planarMap(chains);
    expectConsistent(map);
    // Components: lines that cross nothing are their own.
    const auto edges = static_cast<int>(map.halves.size() / 2);
    const int components = edges - map.vertices + 2 - map.faces;
    EXPECT_LE(components, 1);
    double area = 0;
    for (std::int32_t f = 0; f < map.faces; ++f) {
        if (f != map.outside) {
            EXPECT_GT(areaOf(map, f), 0);
        }
        area += areaOf(map, f);
    }
    EXPECT_NEAR(area, 0, 1e-12);
}

TEST(PlanarMap, OfNothingIsOneFace) {
    const PlanarMap map = planarMap({});
    EXPECT_EQ(map.faces, 1);
    EXPECT_EQ(map.outside, 0);
    EXPECT_TRUE(map.halves.empty());
}

}  // namespace
}  // namespace bandvox
