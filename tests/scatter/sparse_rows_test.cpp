#include "scatter/sparse_rows.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace bandvox {
namespace {

/// Products of hats around random places of a line, some of them nearly the same.
struct HatProducts {
    SparseRows rows;
    std::vector<double> places;
};

HatProducts productsOfHats(std::size_t count, double apart, std::size_t pairs) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> gap(0.5 * apart, 1.5 * apart);
    HatProducts made;
    double place = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool isPair = pairs > 0 && i % std::max<std::size_t>(2, count / pairs) == 1;
        place += isPair ? 1e-3 : gap(random);
        made.places.push_back(place);
    }
    // ∫ of the product of two hats of half width 1 is a cubic B-spline of their distance.
    const auto product = [](double distance) {
        const double d = std::abs(distance);
        if (d >= 2) return 0.0;
        return d >= 1 ? std::pow(2 - d, 3) / 6 : 2.0 / 3 - d * d + d * d * d / 2;
    };
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < count; ++k) {
            const double entry = product(made.places[i] - made.places[k]);
            if (entry == 0) continue;
            made.rows.neighbor.push_back(static_cast<std::uint32_t>(k));
            made.rows.entry.push_back(entry);
        }
        made.rows.start.push_back(made.rows.neighbor.size());
    }
    return made;
}

std::vector<double> randomRight(std::size_t count, double size) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> value(-size, size);
    std::vector<double> right(count);
    for (double& entry : right) entry = value(random);
    return right;
}

double mostLacking(const SparseRows& matrix, const std::vector<double>& x,
                   const std::vector<double>& right) {
    double most = 0;
    for (std::size_t i = 0; i < right.size(); ++i) {
        double lacking = right[i];
        for (std::size_t at = matrix.start[i]; at < matrix.start[i + 1]; ++at) {
            lacking -= matrix.entry[at] * x[matrix.neighbor[at]];
        }
        most = std::max(most, std::abs(lacking));
    }
    return most;
}

TEST(SolveSparseRows, MeetsTheRightSideAcrossSizesAndCrowds) {
    Progress progress;
    for (const std::size_t count : {1u, 2u, 50u, 199u, 200u, 1000u, 5000u}) {
        for (const double apart : {2.5, 0.7, 0.4}) {
            for (const std::size_t pairs : {std::size_t(0), count / 400, count / 20}) {
                for (const double enough : {1e-3, 1e-8}) {
                    const HatProducts hats = productsOfHats(count, apart, pairs);
                    const std::vector<double> right = randomRight(count, 1e-2);
                    const auto x = solveSparseRows(hats.rows, right, enough, 400, progress);
                    EXPECT_LE(mostLacking(hats.rows, x, right), 1.01 * enough)
                        << count << " rows " << apart << " apart, " << pairs << " pairs";
                }
            }
        }
    }
}

TEST(SolveSparseRows, FindsTheMultipliersThatMadeTheRightSide) {
    Progress progress;
    const HatProducts hats = productsOfHats(2000, 0.8, 0);
    const std::vector<double> expected = randomRight(2000, 1);
    std::vector<double> right(2000);
    hats.rows.multiply(expected, right);
    const auto x = solveSparseRows(hats.rows, right, 1e-12, 1000, progress);
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], expected[i], 1e-9) << i;
}

TEST(SolveSparseRows, DoesNotDependOnTheNumberOfThreads) {
    Progress progress;
    const HatProducts hats = productsOfHats(40000 / 4, 0.5, 40);
    const std::vector<double> right = randomRight(hats.rows.size(), 1);
    std::vector<std::vector<double>> found;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        found.push_back(solveSparseRows(hats.rows, right, 1e-9, 400, progress));
    }
    EXPECT_EQ(found[0], found[1]);
    EXPECT_EQ(found[0], found[2]);
}

TEST(SolveSparseRows, StopsAfterSoManyStepsWithoutAnAnswer) {
    Progress progress;
    const HatProducts hats = productsOfHats(1000, 0.4, 100);
    const std::vector<double> right = randomRight(1000, 1);
    const auto x = solveSparseRows(hats.rows, right, 1e-15, 3, progress);
    EXPECT_GT(mostLacking(hats.rows, x, right), 1e-15);
    for (const double entry : x) EXPECT_TRUE(std::isfinite(entry));
}

}  // namespace
}  // namespace bandvox
