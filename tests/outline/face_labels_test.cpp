// What faces of a page show, where that is a function of the place.

#include "outline/fills/face_labels.h"

#include "outline/plain_scene.h"

#include <gtest/gtest.h>

#include <vector>

namespace bandvox::outline_test {
namespace {

const std::vector<PlanarChain> kTwoSquares{{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}},
                                           {{4, 0}, {8, 0}, {8, 4}, {4, 4}}};

// The label of the face that is to the left of the half that starts at a place and ends at another.
FaceLabel labelBeside(const PlanarMap& map, const std::vector<FaceLabel>& labels,
                      std::array<double, 2> from, std::array<double, 2> to) {
    for (const PlanarMap::HalfEdge& half : map.halves) {
        if (half.start == from && map.halves[static_cast<std::size_t>(half.twin)].start == to) {
            return labels[static_cast<std::size_t>(half.face)];
        }
    }
    ADD_FAILURE() << "no such edge";
    return {};
}

TEST(FaceLabels, AreWhatLinesOfSightTell) {
    const PlanarMap map = planarMap(kTwoSquares);
    const PlainScene scene([](double x, double) {
        return x < 4 ? SeenSurface{3, 1, 0.5} : SeenSurface{1, 1, -0.2};
    });
    const std::vector<double> tones{-0.5, 0, 0.4, 0.7};
    const auto labels = faceLabels(map, scene, tones, silentProgress());
    ASSERT_EQ(labels.size(), 3U);
    EXPECT_EQ(labelBeside(map, labels, {0, 0}, {4, 0}), (FaceLabel{3, 3}));
    EXPECT_EQ(labelBeside(map, labels, {4, 0}, {8, 0}), (FaceLabel{1, 1}));
    EXPECT_EQ(labels[static_cast<std::size_t>(map.outside)], FaceLabel());
}

TEST(FaceLabels, AreWhatMostOfAFaceShows) {
    const PlanarMap map = planarMap(kTwoSquares);
    // A speck in the middle of the left square, where the first line of sight goes.
    const PlainScene scene([](double x, double y) {
        const bool isSpeck = std::abs(x - 2) < 0.2 && std::abs(y - 2) < 0.2;
        return SeenSurface{isSpeck ? 0 : 7, 1, 0};
    });
    const auto labels = faceLabels(map, scene, {}, silentProgress());
    EXPECT_EQ(labelBeside(map, labels, {0, 0}, {4, 0}).object, 7);
}

TEST(FaceLabels, OfRingsAreLookedAtOutsideOfTheHole) {
    const PlanarMap map = planarMap(std::vector<PlanarChain>{
        {{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}}, {{1, 1}, {8, 1}, {8, 8}, {1, 8}, {1, 1}}});
    const PlainScene scene([](double x, double y) {
        const bool isHole = x > 1 && x < 8 && y > 1 && y < 8;
        return isHole ? SeenSurface() : SeenSurface{2, 1, 0};
    });
    const auto labels = faceLabels(map, scene, {}, silentProgress());
    EXPECT_EQ(labelBeside(map, labels, {0, 0}, {9, 0}).object, 2);
    EXPECT_EQ(labelBeside(map, labels, {1, 1}, {8, 1}).object, -1);
}

}  // namespace
}  // namespace bandvox::outline_test
