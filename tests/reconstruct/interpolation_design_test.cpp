#include "reconstruct/interpolation_design.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using bandvox::designInterpolation;
using bandvox::ExponentialFilter;
using bandvox::InterpolationDesign;

constexpr double kPi = std::numbers::pi;

double response(const InterpolationDesign& design, double k) {
    double a = design.prefilter[0];
    for (int l = 1; l <= design.reach(); ++l)
        a += 2 * design.prefilter[l] * std::cos(2 * kPi * k * l);
    return a;
}

TEST(InterpolationDesign, UndoesTheKernelWhereTheFilterLeavesAnything) {
    for (const ExponentialFilter& filter :
         {ExponentialFilter{2, 0.16}, {3, 0.2}, {4, 0.2}, {4, 0.28}, {8, 0.35}}) {
        for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
            const InterpolationDesign design = designInterpolation(filter, tolerance);
            EXPECT_LE(design.valueError, tolerance);
            EXPECT_LE(design.gradientError, tolerance);
            EXPECT_NEAR(response(design, 0), 1, 1e-9);
            double total = 0, missed = 0;
            for (double k = 0.0005; k < 0.5; k += 0.001) {
                const double pass = response(design, k) * design.kernel.transform(k);
                total += filter(k);
                missed += filter(k) * std::abs(pass - 1);
                EXPECT_LE(std::abs(pass), 1.1) << "noise is amplified at " << k;
            }
            EXPECT_LE(missed, tolerance * total);
        }
    }
}

TEST(InterpolationDesign, NeedsMoreForLess) {
    int width = 0, reach = 0;
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const InterpolationDesign design = designInterpolation({4, 0.25}, tolerance);
        EXPECT_GE(design.kernel.width(), width);
        EXPECT_GE(design.reach() + design.kernel.width(), reach);
        width = design.kernel.width();
        reach = design.reach() + width;
    }
    EXPECT_GT(width, 5);
}

TEST(InterpolationDesign, RefusesAFilterThatLeavesTooMuchAtNyquist) {
    EXPECT_NO_THROW(designInterpolation({2, 0.2}, 1e-3));
    EXPECT_THROW(designInterpolation({2, 0.2}, 1e-4), bandvox::Error);
    EXPECT_THROW(designInterpolation({0, 0.2}, 1e-2), bandvox::Error);
}

TEST(FaceGradient, IsThatOfAGaussian) {
    // 2 ∫_0^∞ exp(-(k/k_c)²) dk = √π k_c
    EXPECT_NEAR(bandvox::faceGradient({2, 0.12}), std::sqrt(kPi) * 0.12, 1e-6);
}

}  // namespace
