// What is hidden, against exact lines of sight; every free end has to have a reason.

#include "outline/drawing/visible_pieces.h"

#include "outline/drawn_view.h"
#include "outline/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace bandvox::outline_test {
namespace {

// A few of the views that benchmarks/outline_views looks at.
void expectRight(const Scene& scene, int azimuths, int fewestSamples) {
    int samples = 0;
    bool isPerspective = false;
    for (const double elevation : {-0.2, 0.35, 1.0}) {
        for (int k = 0; k < azimuths; ++k, isPerspective = !isPerspective) {
            const double azimuth = 2 * std::numbers::pi * (k + 0.2) / azimuths;
            const DrawnView drawn =
                draw(scene.patches, viewFrom(azimuth, elevation, isPerspective));
            const Findings ends = checkEnds(drawn), sight = checkVisibility(drawn);
            samples += sight.samples;
            for (const Findings* findings : {&ends, &sight}) {
                for (const std::string& message : findings->messages) {
                    ADD_FAILURE() << scene.name << " from " << azimuth << ", " << elevation << ": "
                                  << message;
                }
            }
        }
    }
    EXPECT_GT(samples, fewestSamples);
}

TEST(VisiblePieces, OfATeapotAgreeWithExactLinesOfSight) {
    expectRight({"teapot", teapot()}, 3, 10000);
}

TEST(VisiblePieces, OfTwoTeapotsThatPassThroughEachOtherAgreeWithExactLinesOfSight) {
    expectRight({"two teapots", twoTeapots()}, 1, 10000);
}

TEST(VisiblePieces, OfToriThatPassThroughEachOtherAgreeWithExactLinesOfSight) {
    expectRight({"two tori", twoTori()}, 3, 5000);
}

TEST(VisiblePieces, OfASpiralThatPassesThroughItselfAgreeWithExactLinesOfSight) {
    expectRight({"spiral", spiral()}, 1, 2000);
}

TEST(VisiblePieces, AreWholeLoopsWhereAllIsSeen) {
    const DrawnView drawn = draw(torus(1, 0.4), viewFrom(0.7, 1.2, false));
    ASSERT_EQ(drawn.pieces.size(), 2U);
    for (const VisiblePiece& piece : drawn.pieces) {
        EXPECT_TRUE(piece.curve.closed);
        EXPECT_EQ(piece.hidden, 0);
    }
}

}  // namespace
}  // namespace bandvox::outline_test
