// Where surfaces pass through each other: exact, closed or up to a border, and nothing is missed.

#include "outline/patches/meeting_curves.h"

#include "outline/drawing/page_view.h"
#include "outline/patches/meeting_branches.h"
#include "outline/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bandvox::outline_test {
namespace {

constexpr double kSize = 200;
constexpr ViewMatrix kStraight{{{50, 0, 0, 100}, {0, 50, 0, 100}, {0, 0, 50, 0}, {0, 0, 0, 1}}};

std::vector<MeetingPair> branchesOf(const std::vector<BezierPatch>& patches,
                                    std::vector<ViewPatch>& seen) {
    for (const BezierPatch& patch : patches) seen.push_back(seenBy(kStraight, patch, kSize));
    return meetingBranches(seen, matchSides(patches, seen), kSize, silentProgress());
}

// A patch of degree 2 over [-1, 1]² with heights z = a + b x² + c y².
BezierPatch bowl(double a, double b, double c) {
    BezierPatch patch{.degreeU = 2, .degreeV = 2};
    for (int i = 0; i <= 2; ++i) {
        for (int j = 0; j <= 2; ++j) {
            const double x2 = i == 1 ? -1 : 1, y2 = j == 1 ? -1 : 1;
            patch.control.push_back({i - 1.0, j - 1.0, a + b * x2 + c * y2, 1});
        }
    }
    return patch;
}

TEST(MeetingCurves, FindLoopsThatAreHardlyThere) {
    // A bowl that dips through a plane: a circle of radius r = sqrt(depth).
    for (const double radius : {0.5, 0.1, 0.01, 1e-3}) {
        std::vector<ViewPatch> seen;
        const auto pairs =
            branchesOf({bowl(0.013, 0, 0), bowl(0.013 - radius * radius, 1, 1)}, seen);
        ASSERT_EQ(pairs.size(), 1U) << radius;
        ASSERT_EQ(pairs[0].branches.size(), 1U) << radius;
        const MeetingBranch& loop = pairs[0].branches[0];
        EXPECT_TRUE(loop.closed) << radius;
        for (const MeetingPlace& p : loop.places) {
            EXPECT_NEAR(std::hypot(2 * p[0] - 1, 2 * p[1] - 1), radius, 1e-9) << radius;
        }
    }
}

TEST(MeetingCurves, AreNoneWhereSurfacesOnlyTouchOrJustMiss) {
    for (const double gap : {0.0, 1e-7, 1e-3}) {
        std::vector<ViewPatch> seen;
        EXPECT_TRUE(branchesOf({bowl(0, 0, 0), bowl(gap, 1, 1)}, seen).empty()) << gap;
    }
}

TEST(MeetingCurves, TellBranchesApartThatNearlyCross) {
    // x² - y² = ε: two branches, 2 sqrt(ε) apart.
    for (const double epsilon : {1e-2, 1e-4, 1e-6}) {
        std::vector<ViewPatch> seen;
        const auto pairs = branchesOf({bowl(0, 0, 0), bowl(-epsilon, 1, -1)}, seen);
        ASSERT_EQ(pairs.size(), 1U) << epsilon;
        ASSERT_EQ(pairs[0].branches.size(), 2U) << epsilon;
        for (const MeetingBranch& branch : pairs[0].branches) {
            EXPECT_FALSE(branch.closed);
            const double side = branch.places[0][0] - 0.5;
            for (const MeetingPlace& p : branch.places) {
                const double x = 2 * p[0] - 1, y = 2 * p[1] - 1;
                EXPECT_NEAR(x * x - y * y, epsilon, 1e-11);
                EXPECT_GT(side * x, 0) << epsilon;
            }
            for (const MeetingPlace* end : {&branch.places.front(), &branch.places.back()}) {
                EXPECT_NEAR(std::abs((*end)[0] - 0.5), 0.5, 1e-11) << epsilon;
            }
        }
    }
}

TEST(MeetingCurves, AreNoneBetweenPatchesThatOnlyShareSides) {
    std::vector<ViewPatch> seen, spheres;
    EXPECT_TRUE(branchesOf(torus(1, 0.4), seen).empty());
    EXPECT_TRUE(branchesOf(sphere(1), spheres).empty());
}

TEST(MeetingCurves, OfASurfaceWithItselfAreFound) {
    // A strip that crosses itself: x = t³ - t, z = t², a loop with its node at t = -1 and 1.
    BezierPatch strip{.degreeU = 3, .degreeV = 1};
    // Of t = 3 u - 1.5, in Bernstein's basis.
    const double a = -1.5, b = 1.5;
    const auto blossom3 = [](double r, double s, double t) { return r * s * t; };
    const std::array<std::array<double, 3>, 4> knots{{{a, a, a}, {a, a, b}, {a, b, b}, {b, b, b}}};
    for (const auto& [r, s, t] : knots) {
        const double x = blossom3(r, s, t) - (r + s + t) / 3;
        const double z = (r * s + s * t + t * r) / 3;
        for (const double y : {-1.0, 1.0}) strip.control.push_back({x, y, z, 1});
    }
    std::vector<ViewPatch> seen;
    const auto pairs = branchesOf({strip}, seen);
    ASSERT_EQ(pairs.size(), 1U);
    ASSERT_EQ(pairs[0].branches.size(), 1U);
    for (const MeetingPlace& p : pairs[0].branches[0].places) {
        EXPECT_NEAR(std::abs(3 * p[0] - 1.5), 1, 1e-10);
        EXPECT_NEAR(p[1], p[3], 1e-10);
    }
    EXPECT_FALSE(pairs[0].branches[0].closed);
}

TEST(MeetingCurves, EndOnlyAtBorders) {
    for (const Scene& scene : scenes()) {
        std::vector<ViewPatch> seen;
        const OutlineOptions options = viewFrom(0.4, 0.3, true);
        const ViewMatrix view = pageView(scene.patches, options);
        for (const BezierPatch& patch : scene.patches) {
            seen.push_back(seenBy(view, patch, kSize));
        }
        int found = 0;
        for (const MeetingPair& pair :
             meetingBranches(seen, matchSides(scene.patches, seen), kSize, silentProgress())) {
            for (const MeetingBranch& branch : pair.branches) {
                ++found;
                if (branch.closed) continue;
                for (const MeetingPlace* end : {&branch.places.front(), &branch.places.back()}) {
                    const bool isOnBorder = std::any_of(end->begin(), end->end(),
                                                        [](double x) { return x == 0 || x == 1; });
                    EXPECT_TRUE(isOnBorder) << scene.name;
                }
            }
        }
        EXPECT_GT(found, 0) << scene.name;
    }
}

}  // namespace
}  // namespace bandvox::outline_test
