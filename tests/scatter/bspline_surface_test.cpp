#include <bandvox/core/error.h>
#include <bandvox/scatter/bspline_surface.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace bandvox {
namespace {

BsplineSurface randomSurface(std::array<int, 2> cells, int columns, unsigned seed) {
    const auto count = static_cast<std::size_t>((cells[0] + 3) * (cells[1] + 3) * columns);
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> control(count);
    for (double& value : control) value = uniform(generator);
    return {{-1, 2, 3, 4}, cells, columns, control};
}

/// The value by de Boor's recursion over all knots, slowly.
double splineBySum(const BsplineSurface& surface, double x, double y, int column) {
    const auto spline = [](double t) {
        // The uniform cubic B-spline on [0, 4].
        double sum = 0;
        constexpr std::array<double, 5> kBinomials{1, -4, 6, -4, 1};
        for (std::size_t k = 0; k < 5; ++k) {
            const double part = std::max(t - static_cast<double>(k), 0.0);
            sum += kBinomials[k] * part * part * part / 6;
        }
        return sum;
    };
    const auto [nx, ny] = surface.cells();
    const Rectangle& r = surface.rectangle();
    const double u = (x - r.x0) / r.width() * nx;
    const double v = (y - r.y0) / r.height() * ny;
    double sum = 0;
    for (int i = 0; i < nx + 3; ++i) {
        for (int j = 0; j < ny + 3; ++j) {
            sum += surface.control(column)[static_cast<std::size_t>(i * (ny + 3) + j)] *
                   spline(u - i + 3) * spline(v - j + 3);
        }
    }
    return sum;
}

TEST(BsplineSurface, IsTheSumOfItsSplines) {
    const BsplineSurface surface = randomSurface({5, 3}, 2, 1);
    for (const double x : {-1.0, -0.3, 1.25, 2.9}) {
        for (const double y : {2.0, 2.6, 3.7}) {
            EXPECT_NEAR(surface.value(x, y, 1), splineBySum(surface, x, y, 1), 1e-14);
        }
    }
}

TEST(BsplineSurface, DerivativesAreLimitsOfDifferences) {
    const BsplineSurface surface = randomSurface({6, 4}, 1, 2);
    constexpr double kStep = 1e-5;
    const double x = 0.37;
    const double y = 3.21;
    const SurfaceJet jet = surface.jet(x, y);
    const SurfaceJet right = surface.jet(x + kStep, y);
    const SurfaceJet up = surface.jet(x, y + kStep);
    const SurfaceJet left = surface.jet(x - kStep, y);
    const SurfaceJet down = surface.jet(x, y - kStep);
    EXPECT_NEAR(jet.dx, (right.value - left.value) / (2 * kStep), 1e-7);
    EXPECT_NEAR(jet.dy, (up.value - down.value) / (2 * kStep), 1e-7);
    EXPECT_NEAR(jet.dxx, (right.dx - left.dx) / (2 * kStep), 1e-6);
    EXPECT_NEAR(jet.dxy, (up.dx - down.dx) / (2 * kStep), 1e-6);
    EXPECT_NEAR(jet.dyy, (up.dy - down.dy) / (2 * kStep), 1e-6);
}

TEST(BsplineSurface, IsTwiceContinuouslyDifferentiableAcrossKnots) {
    const BsplineSurface surface = randomSurface({8, 8}, 1, 3);
    const double knot = -1 + 4 * 3 / 8.0;
    constexpr double kBeside = 1e-12;
    const SurfaceJet before = surface.jet(knot - kBeside, 2.9);
    const SurfaceJet after = surface.jet(knot + kBeside, 2.9);
    EXPECT_NEAR(before.value, after.value, 1e-10);
    EXPECT_NEAR(before.dx, after.dx, 1e-9);
    EXPECT_NEAR(before.dxx, after.dxx, 1e-9);
    EXPECT_NEAR(before.dxy, after.dxy, 1e-9);
}

TEST(BsplineSurface, GridsHoldWhatPointsHave) {
    const BsplineSurface surface = randomSurface({5, 7}, 2, 4);
    const auto values = surface.sample({9, 6, 1});
    const auto slopes = surface.sample({9, 6, 1, 1, 1});
    for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 6; ++j) {
            const SurfaceJet jet = surface.jet(-1 + 4 * i / 8.0, 2 + 2 * j / 5.0, 1);
            const auto at = static_cast<std::size_t>(i * 6 + j);
            EXPECT_NEAR(values[at], jet.value, 1e-13);
            EXPECT_NEAR(slopes[at], jet.dxy, 1e-12);
        }
    }
}

TEST(BsplineSurface, RefiningChangesNothing) {
    const BsplineSurface surface = randomSurface({3, 5}, 1, 5);
    const BsplineSurface fine = surface.refinedTo({12, 10});
    EXPECT_EQ(fine.cells(), (std::array{12, 10}));
    BsplineSurface twice = fine;
    twice.add(surface);
    for (const double x : {-1.0, 0.1, 2.2, 3.0}) {
        for (const double y : {2.0, 3.3, 4.0}) {
            EXPECT_NEAR(fine.value(x, y), surface.value(x, y), 1e-14);
            EXPECT_NEAR(twice.value(x, y), 2 * surface.value(x, y), 1e-14);
        }
    }
    EXPECT_THROW(surface.refinedTo({7, 5}), Error);
}

TEST(BsplineSurface, CroppingKeepsWhatIsLeft) {
    const BsplineSurface surface = randomSurface({8, 6}, 2, 6);
    const BsplineSurface part = surface.cropped({2, 1}, {4, 3});
    EXPECT_DOUBLE_EQ(part.rectangle().x0, 0);
    EXPECT_DOUBLE_EQ(part.rectangle().x1, 2);
    EXPECT_NEAR(part.value(0.7, 2.9, 1), surface.value(0.7, 2.9, 1), 1e-14);
}

TEST(BsplineSurface, BezierOrdinatesAreTheSurface) {
    const BsplineSurface surface = randomSurface({4, 3}, 1, 7);
    const auto ordinates = surface.bezierOrdinates(2, 1);
    const auto bernstein = [](double t) {
        const double s = 1 - t;
        return std::array{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    };
    const double u = 0.3;
    const double v = 0.8;
    double value = 0;
    for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b) {
            value += bernstein(u)[a] * bernstein(v)[b] * ordinates[a * 4 + b];
        }
    }
    EXPECT_NEAR(value, surface.value(-1 + 2 + u, 2 + (1 + v) * 2 / 3), 1e-14);
}

TEST(BsplineSurface, CurvatureOfAParaboloid) {
    // z = (x² + y²) / 2 at the origin: both curvatures are 1, the normal is up.
    const SurfaceJet jet{.value = 0, .dx = 0, .dy = 0, .dxx = 1, .dxy = 0, .dyy = 1};
    EXPECT_DOUBLE_EQ(jet.gaussianCurvature(), 1);
    EXPECT_DOUBLE_EQ(jet.meanCurvature(), 1);
    EXPECT_DOUBLE_EQ(jet.normal()[2], 1);
    // A sphere's are the same everywhere: z = -sqrt(1 - x² - y²) at x = 0.6.
    const double z = 0.8;
    const SurfaceJet sphere{
        .value = -z, .dx = 0.6 / z, .dy = 0, .dxx = 1 / (z * z * z), .dxy = 0, .dyy = 1 / z};
    EXPECT_NEAR(sphere.gaussianCurvature(), 1, 1e-14);
    EXPECT_NEAR(sphere.meanCurvature(), 1, 1e-14);
    EXPECT_NEAR(sphere.normal()[0], -0.6, 1e-14);
}

TEST(BsplineSurface, IsNoNumberWhereThePlaceIsNone) {
    const BsplineSurface surface = randomSurface({3, 4}, 1, 5);
    const double none = std::nan("");
    EXPECT_TRUE(std::isnan(surface.value(none, 0)));
    EXPECT_TRUE(std::isnan(surface.value(0, none)));
}

TEST(BsplineSurface, RefusesSizesThatDoNotFit) {
    EXPECT_THROW(BsplineSurface({0, 0, 1, 1}, {2, 2}, 1, std::vector<double>(24)), Error);
    EXPECT_THROW(BsplineSurface({0, 0, 0, 1}, {2, 2}, 1), Error);
    EXPECT_THROW(randomSurface({2, 2}, 1, 8).sample({1, 5}), Error);
}

}  // namespace
}  // namespace bandvox
