#include <bandvox/core/error.h>
#include <bandvox/spectral/exponential_filter.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace bandvox {
namespace {

TEST(ExponentialFilter, FollowsItsFormula) {
    const ExponentialFilter filter{4, 0.25};
    EXPECT_DOUBLE_EQ(filter(0), 1);
    EXPECT_DOUBLE_EQ(filter(0.25), std::exp(-1.0));
    EXPECT_DOUBLE_EQ(filter(-0.25), filter(0.25));
    EXPECT_NEAR(filter.atNyquist(), std::exp(-16.0), 1e-20);
}

// The filtered half-space of a Gaussian is an error function, at every distance.
TEST(ExponentialFilter, HalfSpaceOfGaussianIsErrorFunction) {
    for (const double cutoff : {0.05, 0.16, 0.3}) {
        const double sigma = 1 / (std::numbers::sqrt2 * std::numbers::pi * cutoff);
        for (double r = -20; r <= 20; r += 0.37) {
            const double truth = 0.5 * std::erfc(r / (sigma * std::numbers::sqrt2));
            EXPECT_NEAR(halfSpaceDensity({2, cutoff}, r), truth, 1e-12) << cutoff << " " << r;
        }
    }
}

TEST(ExponentialFilter, HalfSpaceIsSymmetricAboutOneHalf) {
    for (const ExponentialFilter filter : {ExponentialFilter{3, 0.2}, {4, 0.25}, {8, 0.35}}) {
        for (double r = 0; r < 10; r += 0.61) {
            EXPECT_NEAR(halfSpaceDensity(filter, r) + halfSpaceDensity(filter, -r), 1, 1e-12);
        }
    }
}

// The reach is where the density really comes within the tolerance for good.
TEST(ExponentialFilter, ReachIsTheLastPlaceAboveTolerance) {
    for (const ExponentialFilter filter :
         {ExponentialFilter{2, 0.16}, {3, 0.2}, {4, 0.2}, {4, 0.28}, {8, 0.35}}) {
        for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
            const double reach = filterReach(filter, tolerance);
            double largestBeyond = 0;
            for (double r = reach; r < reach + 30; r += 0.1) {
                largestBeyond = std::max(largestBeyond, std::abs(halfSpaceDensity(filter, r)));
            }
            EXPECT_LE(largestBeyond, 1.05 * tolerance) << filter.order << " " << tolerance;
            double largestBefore = 0;
            for (double r = std::max(0.0, reach - 0.5); r < reach; r += 0.05) {
                largestBefore = std::max(largestBefore, std::abs(halfSpaceDensity(filter, r)));
            }
            EXPECT_GT(largestBefore, tolerance) << filter.order << " " << tolerance;
        }
    }
}

TEST(ExponentialFilter, OnlyGaussiansDoNotRing) {
    EXPECT_LT(filterOvershoot({2, 0.16}), 1e-12);
    EXPECT_LT(filterOvershoot({1, 0.05}), 1e-12);
    EXPECT_NEAR(filterOvershoot({4, 0.25}), 0.052, 0.001);
    EXPECT_NEAR(filterOvershoot({8, 0.35}), 0.078, 0.001);
}

TEST(ExponentialFilter, RefusesWhatMakesNoSense) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    for (const ExponentialFilter filter : {ExponentialFilter{0, 0.16},
                                           {-2, 0.16},
                                           {2, 0},
                                           {2, -0.1},
                                           {2, 0.6},
                                           {100, 0.2},
                                           {kNaN, 0.2},
                                           {2, kNaN}}) {
        EXPECT_THROW(requireValid(filter), Error) << filter.order << " " << filter.cutoff;
    }
    EXPECT_NO_THROW(requireValid({2, 0.16}));
    EXPECT_THROW(filterReach({0.5, 0.01}, 1e-6), Error);
}

// Orders below 2 fall off like a power of the distance: their reach ends somewhere, or is refused,
// without a search of minutes.
TEST(ExponentialFilter, LowOrdersReachFarOrAreRefused) {
    EXPECT_THROW(requireValid({0.5, 0.5}), Error);
    EXPECT_NO_THROW(requireValid({1, 0.5}));
    EXPECT_THROW(filterReach({1, 0.5}, 2.5e-5), Error);
    const double reach = filterReach({1, 0.3}, 1e-2);
    EXPECT_LE(std::abs(halfSpaceDensity({1, 0.3}, reach)), 1e-2);
    EXPECT_GT(std::abs(halfSpaceDensity({1, 0.3}, reach - 0.5)), 1e-2);
}

}  // namespace
}  // namespace bandvox
