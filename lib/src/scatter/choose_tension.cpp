#include "scatter/fit_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace bandvox {
namespace {

/// More points tell hardly more, and take longer.
constexpr std::size_t kMostPointsAsked = 160;

/// 16 cells along the longer side.
constexpr int kLevelAsked = 4;

/// In units of the root of the rectangle's area; √2 apart where it matters.
constexpr std::array<double, 9> kTensions{0.25, 1, 2, 2.8, 4, 5.6, 8, 11.2, 16};

/// Points evenly taken of all.
UnitPoints thinned(const UnitPoints& unit) {
    UnitPoints few = unit;
    few.points = {};
    for (auto& values : few.values) values.clear();
    const std::size_t count = std::min(unit.points.size(), kMostPointsAsked);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = k * unit.points.size() / count;
        few.points.u.push_back(unit.points.u[i]);
        few.points.v.push_back(unit.points.v[i]);
        few.points.weight.push_back(1);
        few.points.origin.push_back(static_cast<std::uint32_t>(k));
        for (std::size_t c = 0; c < unit.values.size(); ++c) {
            few.values[c].push_back(unit.values[c][i]);
        }
    }
    return few;
}

/// -2 times the logarithm of how likely the values are, up to a constant, if they come from a
/// normal process of which the energy is the inverse covariance, whatever its variance. The planes
/// count as unknown: their three directions are left out.
double unlikeliness(const UnitPoints& few, const NetPoints& points, double tension) {
    const std::size_t count = few.points.size();
    const SparseFactor factor(makeNormalStencil(points, few.side, tension, 1));
    const std::size_t net = points.shape().count();
    std::vector<double> smoothed(count * count);
    parallelFor(static_cast<std::int64_t>(count), [&](std::int64_t i) {
        std::vector<double> one(count), right(net), solution(net);
        const NetPoints::Place at = points.place(static_cast<std::size_t>(i));
        const auto row = static_cast<std::size_t>(points.shape().points()[1]);
        for (std::size_t k = 0; k < 16; ++k) {
            right[at.first + k / 4 * row + k % 4] = at.x[k / 4] * at.y[k % 4];
        }
        factor.solve(right, solution);
        points.evaluate(solution, one);
        std::copy(
            one.begin(), one.end(),
            smoothed.begin() + static_cast<std::ptrdiff_t>(i * static_cast<std::int64_t>(count)));
    });
    // The energy of the smoothest surface through values v is v^T (S^-1 - 1) v.
    const DenseSymmetric energy = inverseLessOne(smoothed, count);
    constexpr std::size_t kPlanes = 3;
    double determinant = 0;
    for (std::size_t k = kPlanes; k < count; ++k) {
        determinant += std::log(std::max(energy.eigenvalues[k], 1e-300));
    }
    double sum = 0;
    for (const auto& values : few.values) {
        double square = 0;
        for (std::size_t i = 0; i < count; ++i) {
            double image = 0;
            for (std::size_t j = 0; j < count; ++j) {
                image += energy.entries[i * count + j] * values[j];
            }
            square += values[i] * image;
        }
        sum +=
            static_cast<double>(count - kPlanes) * std::log(std::max(square, 1e-300)) - determinant;
    }
    return sum;
}

}  // namespace

double chooseTension(const UnitPoints& unit, Progress& progress) {
    constexpr std::size_t kFewestPoints = 8;
    constexpr double kOtherwise = 2;
    if (unit.points.size() < kFewestPoints) return kOtherwise;
    const UnitPoints few = thinned(unit);
    const NetPoints points(few.points, shapeOfLevel(kLevelAsked, few.side, true));
    std::array<double, kTensions.size()> found{};
    for (std::size_t k = 0; k < kTensions.size(); ++k) {
        progress.throwIfInterrupted();
        found[k] = unlikeliness(few, points, kTensions[k]);
    }
    // What is no number is no likelihood.
    for (double& number : found) {
        if (!std::isfinite(number)) number = std::numeric_limits<double>::max();
    }
    const double least = *std::min_element(found.begin(), found.end());
    if (least == std::numeric_limits<double>::max()) return kOtherwise;
    std::size_t chosen = 0;
    while (found[chosen] > least + 1) ++chosen;
    return kTensions[chosen];
}

}  // namespace bandvox
