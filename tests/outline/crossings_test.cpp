// Where curves may become hidden, against places that are known.

#include "outline/drawing/crossings.h"

#include "outline/plain_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bandvox::outline_test {
namespace {

constexpr CurveSampling kPage{.flatness = 1e-3, .size = 100};

std::vector<CurvePlaces> placesOf(const std::vector<Curve>& curves) {
    const PlainScene scene;
    return crossings(curves, *scene.reader(), kPage);
}

void expectPlaces(const CurvePlaces& found, const CurvePlaces& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9);
}

TEST(Crossings, AreOnTheLineBehind) {
    const std::vector<Curve> curves{chainOf({{10, 20, 5}, {30, 20, 5}}),
                                    chainOf({{15, 10, 9}, {15, 18, 9}, {15, 22, 9}, {15, 30, 9}})};
    const auto places = placesOf(curves);
    expectPlaces(places[0], {});
    expectPlaces(places[1], {1.5});
}

TEST(Crossings, OfLinesAtOneDepthAreOnBoth) {
    const std::vector<Curve> curves{chainOf({{10, 20, 5}, {30, 20, 5}}),
                                    chainOf({{15, 10, 5}, {15, 30, 5}})};
    const auto places = placesOf(curves);
    expectPlaces(places[0], {0.25});
    expectPlaces(places[1], {0.5});
}

TEST(Crossings, BehindALineThatEndsNoSurfaceAreNone) {
    for (const OutlineKind kind :
         {OutlineKind::Crease, OutlineKind::Intersection, OutlineKind::Isophote}) {
        const std::vector<Curve> curves{chainOf({{10, 20, 5}, {30, 20, 5}}, kind),
                                        chainOf({{15, 10, 9}, {15, 30, 9}})};
        const auto places = placesOf(curves);
        expectPlaces(places[0], {});
        expectPlaces(places[1], {});
    }
}

TEST(Crossings, OfLinesOnASurfaceWithOneWhereItMeetsAnotherAreOnBoth) {
    for (const OutlineKind kind :
         {OutlineKind::Crease, OutlineKind::Intersection, OutlineKind::Isophote}) {
        const std::vector<Curve> curves{
            chainOf({{10, 20, 5}, {30, 20, 5}}, OutlineKind::Intersection),
            chainOf({{15, 10, 5}, {15, 30, 5}}, kind)};
        const auto places = placesOf(curves);
        expectPlaces(places[0], {0.25});
        expectPlaces(places[1], {0.5});
    }
}

TEST(Crossings, AreFoundWhereACurveLeavesItsCuspUnevenly) {
    const PlainScene scene([](double, double) { return SeenSurface(); }, 2);
    const std::vector<Curve> curves{chainOf({{10, 20, 9}, {30, 20, 9}}),
                                    chainOf({{28, 10, 5}, {28, 30, 5}})};
    const auto places = crossings(curves, *scene.reader(), kPage);
    ASSERT_EQ(places[0].size(), 1U);
    EXPECT_NEAR(places[0][0], std::sqrt(0.9), 1e-6);
}

TEST(Crossings, OfACurveWithItselfAreFoundButForNeighbours) {
    // A loop: the last part passes behind the first one.
    const std::vector<Curve> curves{
        chainOf({{10, 20, 1}, {40, 20, 1}, {40, 40, 5}, {20, 40, 9}, {20, 10, 9}})};
    expectPlaces(placesOf(curves)[0], {3 + 2.0 / 3});
}

TEST(Crossings, AreWhereALineEndsOnAnotherOne) {
    const std::vector<Curve> curves{chainOf({{10, 20, 5}, {30, 20, 5}}),
                                    chainOf({{25, 20, 5}, {25, 30, 5}}, OutlineKind::Intersection)};
    const auto places = placesOf(curves);
    expectPlaces(places[0], {0.75});
    expectPlaces(places[1], {0});
}

TEST(Crossings, AreNotWhereALineEndsFarBehindAnotherOne) {
    const std::vector<Curve> curves{chainOf({{10, 20, 5}, {30, 20, 5}}, OutlineKind::Crease),
                                    chainOf({{25, 20, 15}, {25, 30, 15}}, OutlineKind::Crease)};
    expectPlaces(placesOf(curves)[0], {});
}

TEST(Crossings, AreWhereAnIntersectionGoesOverAFold) {
    Curve meeting = chainOf({{10, 20, 5}, {20, 20, 5}, {30, 20, 5}}, OutlineKind::Intersection);
    meeting.points[0].u = -1;
    meeting.points[1].u = -0.25;
    meeting.points[2].u = 0.75;
    const auto places = placesOf({meeting});
    ASSERT_EQ(places[0].size(), 1U);
    EXPECT_NEAR(places[0][0], 1.25, 2e-6);
}

}  // namespace
}  // namespace bandvox::outline_test
