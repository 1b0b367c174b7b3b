#include "bandlimit/surface_quadrature.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace bandvox {

namespace {

using std::numbers::pi;

// The error of a rule on exp(2πi κ·y) over an element of side 1 is tabulated for κ = k·side up to
// kLargestSide at Nyquist.
constexpr double kSmallestSide = 0.02;
constexpr double kLargestSide = 10;
constexpr double kWaveStep = 0.05;
constexpr int kWaves = static_cast<int>(0.5 * kLargestSide / kWaveStep) + 2;
constexpr int kDirections = 4;
constexpr double kDeviations = 5;

using WaveErrors = std::array<double, kWaves>;

struct PlanePoint {
    double x, y;
    double weight;
};

// Puts a rule on the equilateral triangle of side 1 about the origin.
std::vector<PlanePoint> onTriangle(std::span<const TrianglePoint> rule) {
    const double height = std::sqrt(0.75);
    std::vector<PlanePoint> points;
    for (const TrianglePoint& p : rule) {
        points.push_back({0.5 * (p.b - p.a), height * (p.c - 1.0 / 3), p.weight});
    }
    return points;
}

// Puts a product rule on the square of side 1 about the origin.
std::vector<PlanePoint> onSquare(std::span<const IntervalPoint> rule) {
    std::vector<PlanePoint> points;
    for (const IntervalPoint& p : rule) {
        for (const IntervalPoint& q : rule) {
            points.push_back({p.position - 0.5, q.position - 0.5, p.weight * q.weight});
        }
    }
    return points;
}

// The best triangle rule on each of 16 parts: the truth for the waves in question.
std::vector<PlanePoint> referenceOnTriangle() {
    constexpr int kParts = 4;
    std::vector<TrianglePoint> points;
    for (int i = 0; i < kParts; ++i) {
        for (int j = 0; i + j < kParts; ++j) {
            for (int down = 0; down < (i + j + 1 < kParts ? 2 : 1); ++down) {
                for (const TrianglePoint& p : triangleRule(kTriangleRules - 1)) {
                    const double a = down ? 1 - p.a : p.a;
                    const double b = down ? 1 - p.b : p.b;
                    TrianglePoint q{(i + a) / kParts, (j + b) / kParts, 0,
                                    p.weight / (kParts * kParts)};
                    q.c = 1 - q.a - q.b;
                    points.push_back(q);
                }
            }
        }
    }
    return onTriangle(points);
}

std::complex<double> waveIntegral(const std::vector<PlanePoint>& points, double kx, double ky) {
    std::complex<double> sum = 0;
    for (const PlanePoint& p : points) {
        sum += p.weight * std::polar(1.0, 2 * pi * (kx * p.x + ky * p.y));
    }
    return sum;
}

// The integrals of waves over an element, for each κ and direction. `symmetry` is the angle in
// which the element repeats itself up to a mirror image.
std::vector<std::complex<double>> waveIntegrals(const std::vector<PlanePoint>& points,
                                                double symmetry) {
    std::vector<std::complex<double>> integrals;
    integrals.reserve(static_cast<std::size_t>(kWaves) * kDirections);
    for (int i = 0; i < kWaves; ++i) {
        const double wave = i * kWaveStep;
        for (int direction = 0; direction < kDirections; ++direction) {
            const double angle = symmetry * (direction + 0.5) / kDirections;
            integrals.push_back(
                waveIntegral(points, wave * std::cos(angle), wave * std::sin(angle)));
        }
    }
    return integrals;
}

// The root mean square over directions of the rule's error, for each κ, `truth` being the
// integrals.
WaveErrors waveErrors(const std::vector<PlanePoint>& rule,
                      const std::vector<std::complex<double>>& truth, double symmetry) {
    const std::vector<std::complex<double>> found = waveIntegrals(rule, symmetry);
    WaveErrors errors{};
    for (std::size_t i = 0; i < kWaves; ++i) {
        double sum = 0;
        for (std::size_t direction = 0; direction < kDirections; ++direction) {
            const std::size_t at = i * kDirections + direction;
            sum += std::norm(found[at] - truth[at]);
        }
        errors[i] = std::sqrt(sum / kDirections);
    }
    return errors;
}

// The standard deviation of the filtered density's error on a surface made of elements of
// side s and area `shape`·s²: σ² = 2π·area ∫_0^{1/2} ε(ks)² H(k)² k dk.
double deviation(const ExponentialFilter& filter, const WaveErrors& errors, double side,
                 double shape) {
    constexpr int kSteps = 64;
    constexpr double kStep = 0.5 / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double k = (i + 0.5) * kStep;
        const double position = k * side / kWaveStep;
        const int below = static_cast<int>(position);
        const double part = position - below;
        const double error = (1 - part) * errors[below] + part * errors[below + 1];
        const double passed = error * filter(k);
        sum += passed * passed * k * kStep;
    }
    return std::sqrt(2 * pi * shape * side * side * sum);
}

double largestSide(const ExponentialFilter& filter, const WaveErrors& errors, double shape,
                   double tolerance) {
    double side = kSmallestSide;
    while (side * 1.02 < kLargestSide &&
           kDeviations * deviation(filter, errors, side * 1.02, shape) <= tolerance) {
        side *= 1.02;
    }
    return side;
}

struct RuleErrors {
    std::array<WaveErrors, kTriangleRules> triangle;
    std::array<WaveErrors, kIntervalRules> cell;
};

RuleErrors computeRuleErrors() {
    RuleErrors errors{};
    constexpr double kOfTriangle = pi / 6, kOfSquare = pi / 4;
    const auto onTriangles = waveIntegrals(referenceOnTriangle(), kOfTriangle);
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        errors.triangle[rule] =
            waveErrors(onTriangle(triangleRule(rule)), onTriangles, kOfTriangle);
    }
    // Two of the finest product rule side by side and one above the other are the truth here.
    std::vector<PlanePoint> fine;
    for (const PlanePoint& p : onSquare(intervalRule(kIntervalRules - 1))) {
        for (const double x : {-0.25, 0.25}) {
            for (const double y : {-0.25, 0.25}) {
                fine.push_back({0.5 * p.x + x, 0.5 * p.y + y, 0.25 * p.weight});
            }
        }
    }
    const auto onSquares = waveIntegrals(fine, kOfSquare);
    for (int rule = 0; rule < kIntervalRules; ++rule) {
        errors.cell[rule] = waveErrors(onSquare(intervalRule(rule)), onSquares, kOfSquare);
    }
    return errors;
}

}  // namespace

SurfaceQuadrature chooseQuadrature(const ExponentialFilter& filter, double tolerance) {
    static const RuleErrors errors = computeRuleErrors();
    SurfaceQuadrature quadrature;
    for (int rule = 0; rule < kTriangleRules; ++rule) {
        quadrature.triangleEdge[rule] =
            largestSide(filter, errors.triangle[rule], std::sqrt(3.0) / 4, tolerance);
    }
    for (int rule = 0; rule < kIntervalRules; ++rule) {
        quadrature.cellSide[rule] = largestSide(filter, errors.cell[rule], 1, tolerance);
    }
    return quadrature;
}

}  // namespace bandvox
