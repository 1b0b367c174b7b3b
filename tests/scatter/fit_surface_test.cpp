#include "scatter/test_points.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/scatter/fit_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using namespace scatter_test;

struct FitErrors {
    double largest = 0;
    double rms = 0;
};

/// On a grid of 101 x 101 places of the unit square, those in the hull of the points.
FitErrors errorsInHull(const BsplineSurface& surface, const Places& places,
                       const PlaneFunction& f) {
    FitErrors errors;
    int count = 0;
    for (int i = 0; i <= 100; ++i) {
        for (int j = 0; j <= 100; ++j) {
            const double x = i / 100.0;
            const double y = j / 100.0;
            if (!isInHull(places, x, y)) continue;
            const double error = std::abs(surface.value(x, y) - f(x, y));
            errors.largest = std::max(errors.largest, error);
            errors.rms += error * error;
            ++count;
        }
    }
    errors.rms = std::sqrt(errors.rms / count);
    return errors;
}

double largestResidual(const BsplineSurface& surface, const ScatteredPoints& points) {
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (int c = 0; c < points.columns; ++c) {
            largest = std::max(
                largest, std::abs(surface.value(points.x[i], points.y[i], c) - points.value(i, c)));
        }
    }
    return largest;
}

double median(std::vector<double> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return (numbers[(numbers.size() - 1) / 2] + numbers[numbers.size() / 2]) / 2;
}

template <typename Call>
std::string inputErrorOf(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

TEST(FitSurface, TakesRandomSamplesOfABump) {
    std::vector<double> largest, rms;
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const Places places = randomPlaces(100, seed);
        const ScatteredPoints points = sampled(places, bump);
        const BsplineSurface surface = fitSurface(points).sum();
        EXPECT_LE(largestResidual(surface, points), 1e-12 * 0.25) << "seed " << seed;
        const FitErrors errors = errorsInHull(surface, places, bump);
        largest.push_back(errors.largest);
        rms.push_back(errors.rms);
    }
    EXPECT_LE(median(largest), 1.45e-3);
    EXPECT_LE(median(rms), 2.5e-4);
}

TEST(FitSurface, ErrsLessThanOthersOnFrankesFunctions) {
    // The least root mean square of SciPy's Clough-Tocher scheme and a thin plate, as
    // benchmarks/scattered_data_against_scipy measures them.
    constexpr std::array<std::array<double, 6>, 3> kOthers{
        {{9.47e-3, 3.799e-3, 8.05e-4, 2.743e-4, 2.22e-3, 1.247e-3},
         {4.246e-2, 1.342e-2, 1.385e-2, 5.612e-3, 2.318e-2, 4.622e-3},
         {3.22e-2, 2.175e-2, 1.343e-2, 3.44e-3, 6.737e-3, 7.379e-3}}};
    const std::array<Places, 3> sets{franke100(), franke33(), lawson25()};
    const auto functions = frankeFunctions();
    for (std::size_t set = 0; set < sets.size(); ++set) {
        for (std::size_t f = 0; f < functions.size(); ++f) {
            const ScatteredPoints points = sampled(sets[set], functions[f]);
            const BsplineSurface surface = fitSurface(points).sum();
            EXPECT_LE(largestResidual(surface, points), 1e-12);
            EXPECT_LT(errorsInHull(surface, sets[set], functions[f]).rms, kOthers[set][f])
                << sets[set].size() << " points, F" << f + 1;
        }
    }
}

TEST(FitSurface, ComesNearMultiquadricsOnFrankesFirst) {
    const PlaneFunction f = frankeFunctions()[0];
    const BsplineSurface surface = fitSurface(sampled(franke100(), f)).sum();
    const FitErrors errors = errorsInHull(surface, franke100(), f);
    EXPECT_LE(errors.largest, 2.5e-2);
    EXPECT_LE(errors.rms, 3.8e-3);
}

TEST(FitSurface, TakesManyPoints) {
    const PlaneFunction f = frankeFunctions()[0];
    const ScatteredPoints points = sampled(randomPlaces(100000, 5), f);
    const SurfaceFit fit = fitSurface(points);
    EXPECT_LE(fit.report.back().largest, 1e-12);
    const BsplineSurface surface = fit.sum();
    EXPECT_LE(largestResidual(surface, points), 2e-12);
    constexpr int kSide = 201;
    const auto samples = surface.sample({kSide, kSide});
    const Rectangle& r = surface.rectangle();
    double largest = 0;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const double x = r.x0 + r.width() * i / (kSide - 1);
            const double y = r.y0 + r.height() * j / (kSide - 1);
            largest = std::max(
                largest, std::abs(samples[static_cast<std::size_t>(i * kSide + j)] - f(x, y)));
        }
    }
    EXPECT_LE(largest, 2e-6);
}

TEST(FitSurface, LevelsAddUpAndGrowFiner) {
    const ScatteredPoints points = sampled(randomPlaces(200, 7), bump);
    const SurfaceFit fit = fitSurface(points);
    ASSERT_EQ(fit.levels.size(), fit.report.size());
    const auto [low, high] = std::minmax_element(points.values.begin(), points.values.end());
    double before = 1;
    for (std::size_t i = 0; i < fit.levels.size(); ++i) {
        EXPECT_LT(fit.report[i].rms, before);
        before = fit.report[i].rms;
        EXPECT_EQ(fit.levels[i].cells(), fit.report[i].cells);
        // What the report says of a level is so of the sum up to there.
        EXPECT_NEAR(largestResidual(fit.sum(0, i), points) / (*high - *low), fit.report[i].largest,
                    1e-9 * fit.report[i].largest + 1e-14);
    }
}

TEST(FitSurface, ReproducesPlanesEvenFarFromPoints) {
    const auto plane = [](double x, double y) { return 3 + 2 * x - 5 * y; };
    const ScatteredPoints points = sampled({{0, 0}, {1, 0.1}, {0.2, 0.9}, {0.4, 0.3}}, plane);
    FitSurfaceOptions options;
    options.tension = 0.05;
    const BsplineSurface surface = fitSurface(points, options).sum();
    for (const double x : {0.0, 0.5, 1.0}) {
        for (const double y : {0.0, 0.45, 0.9}) {
            EXPECT_NEAR(surface.value(x, y), plane(x, y), 1e-3);
        }
    }
}

TEST(FitSurface, ColumnsAreWhatEachWouldBeAlone) {
    const auto functions = frankeFunctions();
    ScatteredPoints both;
    both.columns = 2;
    for (const auto& [x, y] : franke33()) {
        both.x.push_back(x);
        both.y.push_back(y);
        both.values.push_back(functions[2](x, y));
        both.values.push_back(-7 * functions[3](x, y));
    }
    FitSurfaceOptions options;
    options.tension = 2;
    const BsplineSurface together = fitSurface(both, options).sum();
    const BsplineSurface alone = fitSurface(sampled(franke33(), functions[2]), options).sum();
    for (const double x : {0.1, 0.5, 0.9}) {
        EXPECT_NEAR(together.value(x, 0.3, 0), alone.value(x, 0.3), 1e-11);
    }
    EXPECT_LE(largestResidual(together, both), 1e-11);
}

TEST(FitSurface, IsTheSameForAnyNumberOfThreads) {
    const ScatteredPoints points = sampled(randomPlaces(5000, 3), frankeFunctions()[0]);
    std::vector<double> first;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        const BsplineSurface surface = fitSurface(points).sum();
        const auto control = surface.control(0);
        if (first.empty()) {
            first.assign(control.begin(), control.end());
        } else {
            EXPECT_TRUE(std::equal(control.begin(), control.end(), first.begin(), first.end()));
        }
    }
}

TEST(FitSurface, SmoothsAsMuchAsTheNoise) {
    const Places places = randomPlaces(2000, 11);
    ScatteredPoints points = sampled(places, bump);
    std::mt19937 generator(1);
    std::normal_distribution<double> normal(0, 0.02);
    double squares = 0;
    for (double& value : points.values) value += normal(generator);
    FitSurfaceOptions options;
    options.noise = 0.02;
    const SurfaceFit fit = fitSurface(points, options);
    const BsplineSurface surface = fit.sum();
    for (std::size_t i = 0; i < points.size(); ++i) {
        squares += square(surface.value(points.x[i], points.y[i]) - points.values[i]);
    }
    EXPECT_NEAR(std::sqrt(squares / 2000), 0.02, 0.0005);
    EXPECT_LE(errorsInHull(surface, places, bump).rms, 0.02 / 4);
}

TEST(FitSurface, TakesFewPointsAndPointsOnLines) {
    for (const Places& places :
         {Places{{0, 0}, {1, 1}}, Places{{0, 0}, {1, 0}}, Places{{2, 3}, {5, 3}, {9, 3}},
          Places{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}}, Places{{0, 0}, {1, 0}, {0, 1}}}) {
        const ScatteredPoints points =
            sampled(places, [](double x, double y) { return x * x - y; });
        const SurfaceFit fit = fitSurface(points);
        const BsplineSurface surface = fit.sum();
        EXPECT_LE(largestResidual(surface, points), 2e-11);
        for (const double value : surface.sample({33, 33})) EXPECT_TRUE(std::isfinite(value));
    }
}

TEST(FitSurface, TakesClustersAndFlatRectangles) {
    Places clustered = randomPlaces(60, 2);
    for (auto [x, y] : randomPlaces(60, 4)) clustered.emplace_back(0.3 + 0.01 * x, 0.6 + 0.01 * y);
    const ScatteredPoints points = sampled(clustered, frankeFunctions()[0]);
    const SurfaceFit fit = fitSurface(points);
    EXPECT_LE(largestResidual(fit.sum(), points), 2e-12);

    Places flat = randomPlaces(300, 9);
    for (auto& place : flat) place.first *= 1000;
    const ScatteredPoints wave =
        sampled(flat, [](double x, double y) { return std::sin(x / 40) + 0.1 * y; });
    const BsplineSurface surface = fitSurface(wave).sum();
    EXPECT_LE(largestResidual(surface, wave), 3e-12);
    EXPECT_NEAR(surface.value(500, 0.5), std::sin(12.5) + 0.05, 0.05);
}

TEST(FitSurface, NoLevelMakesItWorse) {
    // A crowd, and one far away.
    ScatteredPoints points;
    points.columns = 1;
    for (int i = 0; i < 200; ++i) {
        const double x = std::fmod(i * 0.754877666246693, 1.0);
        const double y = std::fmod(i * 0.569840290998053, 1.0);
        points.x.push_back(x);
        points.y.push_back(y);
        points.values.push_back(std::sin(5 * x) * std::cos(4 * y) + x);
    }
    points.x.push_back(1000);
    points.y.push_back(1000);
    points.values.push_back(0);
    FitSurfaceOptions options;
    options.maxLevel = 10;
    const SurfaceFit fit = fitSurface(points, options);
    ASSERT_FALSE(fit.report.empty());
    EXPECT_LE(fit.report.back().largest, 1);
    for (std::size_t i = 1; i < fit.report.size(); ++i) {
        EXPECT_LE(fit.report[i].largest, 1.5 * fit.report[i - 1].largest) << i;
    }
}

TEST(FitSurface, RefusesARangeThatIsNoNumber) {
    ScatteredPoints points;
    points.columns = 1;
    points.x = {0, 1, 0, 1};
    points.y = {0, 0, 1, 1};
    points.values = {1.2e308, -1.2e308, 0, 1};
    EXPECT_THROW(fitSurface(points), Error);
}

TEST(FitSurface, TellsWhatTheSumOfTheLevelsLeaves) {
    // Of values far from 0 the sum keeps less than its levels do one by one.
    for (const double offset : {0.0, 1e3, 1e6}) {
        const ScatteredPoints points = sampled(
            randomPlaces(400, 9), [&](double x, double y) { return offset + 0.01 * bump(x, y); });
        const auto [low, high] = std::minmax_element(points.values.begin(), points.values.end());
        const SurfaceFit fit = fitSurface(points);
        const double left = largestResidual(fit.sum(), points) / (*high - *low);
        EXPECT_NEAR(fit.report.back().largest, left, 1e-9 * left) << offset;
        EXPECT_EQ(left > 1e-12, offset > 0) << offset;
    }
}

TEST(FitSurface, NamesTheColumnInWhichDuplicatesDisagree) {
    ScatteredPoints points;
    points.x = {0, 1, 0, 1};
    points.y = {0, 0, 1, 0};
    points.columns = 2;
    points.values = {1, 2, 2, 3, 1, 4, 2, 9};
    const std::string numbered = inputErrorOf([&] { fitSurface(points); });
    EXPECT_NE(numbered.find(" in value 2;"), std::string::npos) << numbered;
    points.names = {"height", "heat"};
    const std::string named = inputErrorOf([&] { fitSurface(points); });
    EXPECT_NE(named.find(" in heat;"), std::string::npos) << named;
}

TEST(FitSurface, AveragesDuplicatesOrRefusesThem) {
    ScatteredPoints points = sampled(franke33(), bump);
    points.x.push_back(points.x[4]);
    points.y.push_back(points.y[4]);
    points.values.push_back(points.values[4]);
    const SurfaceFit fit = fitSurface(points);
    EXPECT_EQ(fit.points, 33U);
    EXPECT_EQ(fit.duplicates, 1U);
    points.values.back() += 0.01;
    const std::string message = inputErrorOf([&] { fitSurface(points); });
    EXPECT_NE(message.find("(0.1, 0.15)"), std::string::npos) << message;
    FitSurfaceOptions options;
    options.tolerance = 0.1;
    EXPECT_NO_THROW(fitSurface(points, options));
}

TEST(FitSurface, RefusesWhatHasNoSurface) {
    ScatteredPoints none;
    EXPECT_NE(inputErrorOf([&] { fitSurface(none); }), "");
    const ScatteredPoints one = sampled({{2, 3}}, bump);
    EXPECT_NE(inputErrorOf([&] { fitSurface(one); }).find("(2, 3)"), std::string::npos);
    ScatteredPoints outside = sampled(franke33(), bump);
    FitSurfaceOptions options;
    options.rectangle = Rectangle{0.01, 0, 1, 1};
    EXPECT_NE(inputErrorOf([&] { fitSurface(outside, options); }).find("outside"),
              std::string::npos);
    outside.values[3] = NAN;
    EXPECT_NE(inputErrorOf([&] { fitSurface(outside); }).find("finite"), std::string::npos);
    options = {};
    options.tolerance = 2;
    EXPECT_THROW(fitSurface(one, options), Error);
}

}  // namespace
}  // namespace bandvox
