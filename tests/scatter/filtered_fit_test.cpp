#include "scatter/filter_cascade.h"
#include "scatter/test_points.h"

#include <bandvox/core/error.h>
#include <bandvox/scatter/filtered_fit.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using namespace scatter_test;

TEST(FilterCascade, IsTheEquationOfThePaper) {
    const std::vector<double> line{1, 4, -2, 7, 3};
    const auto half = filterLine(line, 2);
    ASSERT_EQ(half.size(), 3U);
    EXPECT_DOUBLE_EQ(half[0], 1.0 / 6 + 2.0 / 3 + 4.0 / 6);
    EXPECT_DOUBLE_EQ(half[1], (4 - 8 + 7) / 6.0);
    EXPECT_DOUBLE_EQ(half[2], 7.0 / 6 + 2 + 0.5);
    for (const double value : filterLine(std::vector<double>(17, 3.5), 1)) {
        EXPECT_DOUBLE_EQ(value, 3.5);
    }
}

TEST(FilterCascade, GivesRowsWhatItGivesLines) {
    constexpr std::size_t kCells = 32;
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> column(kCells + 1);
    for (double& value : column) value = uniform(generator);
    std::vector<double> found;
    RowCascade cascade(kCells, 4, [&](const std::vector<double>& row) {
        ASSERT_EQ(row.size(), 2U);
        found.push_back(row[0]);
        EXPECT_NEAR(row[1], 2 * row[0], 1e-15);
    });
    for (const double value : column) cascade.push({value, 2 * value});
    const auto expected = filterLine(column, 4);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-15);
}

TEST(FilteredFit, KeepsAConstant) {
    const ScatteredPoints points =
        sampled(randomPlaces(30, 1), [](double, double) { return 4.25; });
    const BsplineSurface surface = fitByFiltering(points, {.levels = 2}).sum();
    for (const double value : surface.sample({20, 20})) EXPECT_NEAR(value, 4.25, 1e-12);
}

TEST(FilteredFit, ComesNearerLevelByLevel) {
    const ScatteredPoints points = sampled(randomPlaces(100, 0), bump);
    const SurfaceFit fit = fitByFiltering(points, {.levels = 5});
    double before = 1;
    for (const FitLevel& level : fit.report) {
        EXPECT_LT(level.rms, before);
        before = level.rms;
    }
    EXPECT_LT(before, 0.02);
    const BsplineSurface surface = fit.sum();
    EXPECT_NEAR(surface.value(0.5, 0.5), 0.25, 0.02);
    // What the report says is so of the sum.
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        largest =
            std::max(largest, std::abs(surface.value(points.x[i], points.y[i]) - points.values[i]));
    }
    const auto [low, high] = std::minmax_element(points.values.begin(), points.values.end());
    EXPECT_NEAR(largest / (*high - *low), fit.report.back().largest, 1e-12);
}

TEST(FilteredFit, RefusesPointsOnALine) {
    EXPECT_THROW(fitByFiltering(sampled({{0, 0}, {1, 1}, {2, 2}}, bump)), Error);
    EXPECT_THROW(fitByFiltering(sampled(franke33(), bump), {.levels = 10}), Error);
}

}  // namespace
}  // namespace bandvox
