// What follows from the tolerance: the numbers that docs/math/exact-route.md gives.

#include "bandlimit/tile_plan.h"

#include <bandvox/source/quadrature.h>

#include <gtest/gtest.h>

namespace bandvox {
namespace {

struct Expected {
    ExponentialFilter filter;
    int widths[3];    // of the kernel, at tolerances of 1e-3, 1e-4, 1e-5
    int halo;         // at 1e-4
    double edges[5];  // of triangles under the rules of 1, 3, 7, 16, 33 points, at 1e-4
};

constexpr double kTolerances[] = {1e-3, 1e-4, 1e-5};
constexpr std::size_t kPoints[] = {1, 3, 7, 16, 33};

const Expected kExpected[] = {
    {{2, 0.16}, {6, 7, 7}, 6, {0.08, 0.67, 1.9, 4.2, 7.2}},
    {{4, 0.28}, {6, 8, 9}, 8, {0.05, 0.44, 1.4, 3.3, 6.0}},
    {{8, 0.35}, {6, 8, 9}, 14, {0.03, 0.35, 1.2, 2.9, 5.4}},
};

TilePlan planFor(const ExponentialFilter& filter, double tolerance) {
    DensityOptions options;
    options.filter = filter;
    options.tolerance = tolerance;
    return makeTilePlan(options);
}

TEST(TilePlan, KernelAndHaloAreAsDocumented) {
    for (const Expected& expected : kExpected) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(planFor(expected.filter, kTolerances[i]).kernel.width(), expected.widths[i])
                << expected.filter.order << " " << kTolerances[i];
        }
        EXPECT_EQ(planFor(expected.filter, 1e-4).halo, expected.halo) << expected.filter.order;
    }
}

TEST(TilePlan, TrianglesAreAsLargeAsDocumented) {
    for (const Expected& expected : kExpected) {
        const TilePlan plan = planFor(expected.filter, 1e-4);
        for (int i = 0; i < 5; ++i) {
            int rule = 0;
            while (triangleRule(rule).size() != kPoints[i]) ++rule;
            EXPECT_NEAR(plan.quadrature.triangleEdge[rule], expected.edges[i], i < 2 ? 0.006 : 0.06)
                << expected.filter.order << " " << kPoints[i];
        }
    }
}

// Tighter tolerances never ask for less.
TEST(TilePlan, GrowsAsTheToleranceFalls) {
    for (const Expected& expected : kExpected) {
        for (double tolerance = 0.05; tolerance > 2e-6; tolerance /= 2) {
            const TilePlan loose = planFor(expected.filter, tolerance);
            const TilePlan tight = planFor(expected.filter, tolerance / 2);
            EXPECT_GE(tight.halo, loose.halo) << tolerance;
            EXPECT_GE(tight.kernel.width(), loose.kernel.width()) << tolerance;
            EXPECT_LT(tight.threshold, loose.threshold);
            EXPECT_GE(tight.interior, 2);
        }
    }
}

}  // namespace
}  // namespace bandvox
