// Contours on patches: nothing is missed, all of it is exact, and cusps are counted right.

#include "outline/patches/fold_curves.h"

#include "outline/drawing/join_curves.h"
#include "outline/patches/border_curves.h"
#include "outline/sample_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox::outline_test {
namespace {

constexpr double kSize = 200;

// A parallel view from an azimuth and an elevation, 60 page units to a world unit.
ViewMatrix viewFrom(double azimuth, double elevation) {
    const double ca = std::cos(azimuth), sa = std::sin(azimuth);
    const double ce = std::cos(elevation), se = std::sin(elevation);
    constexpr double kScale = 60;
    return {{{-kScale * sa, kScale * ca, 0, 100},
             {kScale * se * ca, kScale * se * sa, -kScale * ce, 100},
             {-kScale * ce * ca, -kScale * ce * sa, -kScale * se, 0},
             {0, 0, 0, 1}}};
}

std::vector<Curve> contoursOf(const std::vector<BezierPatch>& patches, const ViewMatrix& view,
                              std::vector<ViewPatch>& seen) {
    const CurveSampling sampling{.flatness = 2.5e-3, .size = kSize};
    std::vector<Curve> folds;
    for (const BezierPatch& patch : patches) {
        seen.push_back(seenBy(view, patch, kSize));
        const auto some = foldCurves(seen.back(), static_cast<int>(seen.size()) - 1, sampling);
        folds.insert(folds.end(), some.begin(), some.end());
    }
    const BorderCurves borders =
        borderCurves(patches, seen, matchSides(patches, seen), folds, 0.99, sampling);
    EXPECT_TRUE(borders.boundaries.empty());
    EXPECT_TRUE(borders.creases.empty());
    folds.insert(folds.end(), borders.contours.begin(), borders.contours.end());
    return joinCurves(folds, sampling);
}

int cornersOf(const std::vector<Curve>& curves) {
    int corners = 0;
    for (const Curve& curve : curves) {
        const std::size_t count = curve.points.size();
        for (std::size_t i = 0; i < count; ++i) {
            if (!curve.points[i].corner) continue;
            const CurvePoint& before = curve.points[i > 0 ? i - 1 : count - 2];
            const bool isRepeated =
                std::hypot(before.x - curve.points[i].x, before.y - curve.points[i].y) < 1e-6 &&
                before.corner;
            const bool isClosing = i + 1 == count && curve.closed && curve.points[0].corner;
            if (!isRepeated && !isClosing) ++corners;
        }
    }
    return corners;
}

TEST(FoldCurves, OfATorusHaveTheSameTopologyFromAllAround) {
    const std::vector<BezierPatch> patches = torus(1, 0.4);
    const auto expectCusps = [&](double elevation, int expected, int azimuths) {
        for (int k = 0; k < azimuths; ++k) {
            const double azimuth = 2 * std::numbers::pi * (k + 0.137) / azimuths;
            std::vector<ViewPatch> seen;
            const auto curves = contoursOf(patches, viewFrom(azimuth, elevation), seen);
            ASSERT_EQ(curves.size(), 2U) << azimuth << " " << elevation;
            EXPECT_TRUE(curves[0].closed && curves[1].closed);
            EXPECT_EQ(cornersOf(curves), expected) << azimuth << " " << elevation;
        }
    };
    expectCusps(0.1, 4, 1000);
    for (const double elevation : {0.7, 0.9, 1.2, 1.5}) expectCusps(elevation, 0, 50);
}

TEST(FoldCurves, AreExact) {
    std::vector<ViewPatch> seen;
    for (const Curve& curve : contoursOf(torus(1, 0.4), viewFrom(0.3, 0.5), seen)) {
        for (const CurvePoint& p : curve.points) {
            const ViewPatch& patch = seen[static_cast<std::size_t>(p.patch)];
            const double scale = patch.f.largestMagnitude();
            EXPECT_LT(std::abs(evaluate(patch.f, p.u, p.v).value), 1e-11 * scale);
        }
    }
}

TEST(FoldCurves, FindSmallLoops) {
    // A bump of one control point on a plane that is seen at a slant folds in a small loop.
    BezierPatch patch{.degreeU = 8, .degreeV = 8};
    for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j) patch.control.push_back({i / 8.0, j / 8.0, 0, 1});
    }
    patch.at(4, 4)[2] = 4;
    const CurveSampling sampling{.flatness = 2.5e-3, .size = kSize};
    const ViewPatch steep = seenBy(viewFrom(0.3, 1.5), patch, kSize);
    EXPECT_TRUE(foldCurves(steep, 0, sampling).empty());
    // The elevation at which the fold appears, by halving; just below it there is a tiny loop.
    double without = 1.5, with = 0.1;
    for (int step = 0; step < 40; ++step) {
        const double middle = 0.5 * (without + with);
        (foldCurves(seenBy(viewFrom(0.3, middle), patch, kSize), 0, sampling).empty() ? without
                                                                                      : with) =
            middle;
    }
    const auto curves = foldCurves(seenBy(viewFrom(0.3, with - 1e-7), patch, kSize), 0, sampling);
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_TRUE(curves[0].closed);
    const auto [low, high] =
        std::minmax_element(curves[0].points.begin(), curves[0].points.end(),
                            [](const CurvePoint& a, const CurvePoint& b) { return a.u < b.u; });
    EXPECT_LT(high->u - low->u, 1e-3);
    EXPECT_EQ(std::count_if(curves[0].points.begin(), curves[0].points.end(),
                            [](const CurvePoint& p) { return p.corner; }),
              2);
}

TEST(FoldCurves, OfACollapsedPatchAreNone) {
    BezierPatch patch{.degreeU = 3, .degreeV = 3};
    patch.control.assign(16, {0.1, 0.2, 0.3, 1});
    const ViewPatch seen = seenBy(viewFrom(0.3, 0.4), patch, kSize);
    EXPECT_FALSE(seen.hasFold);
    EXPECT_TRUE(foldCurves(seen, 0, {.flatness = 1e-3, .size = kSize}).empty());
}

}  // namespace
}  // namespace bandvox::outline_test
