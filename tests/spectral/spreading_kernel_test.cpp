#include <bandvox/core/error.h>
#include <bandvox/spectral/spreading_kernel.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace bandvox {
namespace {

// The transform by its definition, with a sum that is far finer than needed.
double directTransform(const SpreadingKernel& kernel, double k) {
    constexpr int kSteps = 20000;
    const double step = static_cast<double>(kernel.width()) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = -0.5 * kernel.width() + (i + 0.5) * step;
        sum += kernel(x) * std::cos(2 * std::numbers::pi * k * x) * step;
    }
    return sum;
}

class SpreadingKernelOfWidth : public testing::TestWithParam<int> {
  protected:
    SpreadingKernel kernel{GetParam(), 2.1 * GetParam()};
};

TEST_P(SpreadingKernelOfWidth, TransformIsThatOfTheKernel) {
    EXPECT_NEAR(kernel.transform(0), 1, 1e-14);
    for (double k = 0; k < 2; k += 0.13) {
        EXPECT_NEAR(kernel.transform(k), directTransform(kernel, k), 1e-7) << k;
        EXPECT_DOUBLE_EQ(kernel.transform(k), kernel.transform(-k));
    }
}

TEST_P(SpreadingKernelOfWidth, WeightsAreTheKernelAtTheNodes) {
    float weights[SpreadingKernel::kPaddedWidth];
    float derivatives[SpreadingKernel::kPaddedWidth];
    const double scale = kernel(0);
    for (float x = 20; x < 23; x += 0.0371F) {
        const int first = kernel.weights(x, weights, derivatives);
        EXPECT_GE(first, x - 0.5F * kernel.width());
        EXPECT_LT(first, x - 0.5F * kernel.width() + 1);
        for (int j = 0; j < kernel.width(); ++j) {
            const double distance = first + j - static_cast<double>(x);
            EXPECT_NEAR(weights[j], kernel(distance), 1e-6 * scale) << x << " " << j;
            // The derivative with respect to the place has the opposite sign. The kernel ends
            // with a small step, where its own derivative is not smooth.
            EXPECT_NEAR(derivatives[j], -kernel.derivative(distance), 3e-5 * scale)
                << x << " " << j;
        }
        for (int j = kernel.width(); j < kernel.paddedWidth(); ++j) {
            EXPECT_EQ(weights[j], 0);
            EXPECT_EQ(derivatives[j], 0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Widths, SpreadingKernelOfWidth, testing::Range(4, 13));

TEST(SpreadingKernel, DerivativeIsThatOfTheKernel) {
    const SpreadingKernel kernel(7, 15.0);
    for (double x = -3.4; x < 3.4; x += 0.17) {
        const double difference = (kernel(x + 1e-5) - kernel(x - 1e-5)) / 2e-5;
        EXPECT_NEAR(kernel.derivative(x), difference, 1e-8) << x;
    }
}

// Spreading points of a plane and dividing by the transform must give the filtered half-space
// back: the error of the one-dimensional route is what aliasError says, for every phase.
TEST(SpreadingKernel, AliasErrorBoundsTheHalfSpace) {
    for (const ExponentialFilter filter : {ExponentialFilter{2, 0.16}, {4, 0.25}, {8, 0.35}}) {
        for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
            const SpreadingKernel kernel = SpreadingKernel::forFilter(filter, tolerance);
            const double bound = aliasError(filter, kernel);
            EXPECT_LE(bound, tolerance);
            constexpr int kPeriod = 256;
            double worst = 0;
            for (const double phase : {0.0, 0.13, 0.37, 0.5, 0.81}) {
                // A source at 64 and its opposite half a period on, so that the sum closes.
                for (int x = 52; x < 76; ++x) {
                    double density = 0;
                    for (int i = 1; i < kPeriod / 2; i += 2) {
                        const double k = static_cast<double>(i) / kPeriod;
                        // What the lattice sees of a unit source is its aliased transform.
                        double seen = 0;
                        const double shift = x - (64 + phase);
                        for (int m = -3; m <= 3; ++m) {
                            seen += kernel.transform(k + m) *
                                    std::sin(2 * std::numbers::pi * (k * shift - m * (64 + phase)));
                        }
                        density +=
                            4 * filter(k) / kernel.transform(k) * seen / (2 * std::numbers::pi * i);
                    }
                    const double truth = 0.5 - halfSpaceDensity(filter, x - 64 - phase);
                    worst = std::max(worst, std::abs(density - truth));
                }
            }
            // The truth differs by what the lattice cannot hold.
            EXPECT_LE(worst, bound + filter.atNyquist()) << filter.order << " " << tolerance;
        }
    }
}

TEST(SpreadingKernel, TighterTolerancesTakeWiderKernels) {
    int last = 0;
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
        const int width = SpreadingKernel::forFilter({4, 0.2}, tolerance).width();
        EXPECT_GE(width, last);
        last = width;
    }
    EXPECT_GT(last, 5);
}

TEST(SpreadingKernel, RefusesWhatCannotBe) {
    EXPECT_THROW(SpreadingKernel(1, 3), Error);
    EXPECT_THROW(SpreadingKernel(13, 3), Error);
    EXPECT_THROW(SpreadingKernel(6, 0), Error);
    EXPECT_THROW(SpreadingKernel::forFilter({2, 0.5}, 1e-6), Error);
}

}  // namespace
}  // namespace bandvox
