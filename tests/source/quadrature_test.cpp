#include <bandvox/source/quadrature.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

double factorial(int n) {
    return std::tgamma(n + 1.0);
}

/// The integral of b^i c^j over a triangle of area 1.
double exactMonomial(int i, int j) {
    return 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
}

double ruleMonomial(int rule, int i, int j) {
    double sum = 0.0;
    for (const TrianglePoint& p : triangleRule(rule)) {
        sum += p.weight * std::pow(p.b, i) * std::pow(p.c, j);
    }
    return sum;
}

TEST(TriangleRule, IntegratesAllMonomialsUpToItsDegree) {
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        const int degree = triangleRuleDegree(rule);
        for (int i = 0; i <= degree; ++i) {
            for (int j = 0; i + j <= degree; ++j) {
                EXPECT_NEAR(ruleMonomial(rule, i, j), exactMonomial(i, j),
                            5e-15)  // printed to 15 digits
                    << "rule " << rule << ", b^" << i << " c^" << j;
            }
        }
    }
}

TEST(TriangleRule, HasNoHigherDegreeThanItClaims) {
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        const int degree = triangleRuleDegree(rule) + 1;
        double worst = 0.0;
        for (int i = 0; i <= degree; ++i) {
            const double exact = exactMonomial(i, degree - i);
            worst = std::max(worst, std::abs(ruleMonomial(rule, i, degree - i) / exact - 1.0));
        }
        EXPECT_GT(worst, 1e-6) << "rule " << rule;
    }
}

TEST(TriangleRule, PointsLieInsideAndWeightsArePositive) {
    constexpr std::size_t kCounts[kTriangleRules] = {1, 3, 6, 7, 12, 16, 25, 33};
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        EXPECT_EQ(triangleRule(rule).size(), kCounts[rule]);
        for (const TrianglePoint& p : triangleRule(rule)) {
            EXPECT_NEAR(p.a + p.b + p.c, 1.0, 1e-15);
            EXPECT_GT(std::min({p.a, p.b, p.c, p.weight}), 0.0);
        }
    }
}

TEST(IntervalRule, IntegratesAllMonomialsUpToItsDegree) {
    for (int rule = 0; rule < kIntervalRules; ++rule) {
        ASSERT_EQ(intervalRule(rule).size(), static_cast<std::size_t>(rule + 1));
        const auto monomial = [rule](int power) {
            double sum = 0.0;
            for (const IntervalPoint& p : intervalRule(rule)) {
                sum += p.weight * std::pow(p.position, power);
            }
            return sum;
        };
        const int degree = 2 * rule + 1;
        for (int power = 0; power <= degree; ++power) {
            EXPECT_NEAR(monomial(power), 1.0 / (power + 1), 2e-15) << rule << " x^" << power;
        }
        EXPECT_GT(std::abs(monomial(degree + 1) - 1.0 / (degree + 2)), 1e-11);
    }
}

}  // namespace
}  // namespace bandvox
