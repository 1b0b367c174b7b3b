#include "fit_curve.h"

#include "source/parameter_curve.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace bandvox {
namespace {

constexpr std::size_t kMostPieces = 1024;
constexpr double kFarthest = 1e100;  // sums of such places are finite
constexpr double kShortest = 1e-7;   // of the whole: what is shorter nobody sees

/// Interpolation at the extrema of a Chebyshev polynomial, in Bernstein's basis.
class Interpolation {
  public:
    explicit Interpolation(std::size_t degree) : mNodes(degree + 1) {
        const std::size_t count = degree + 1;
        for (std::size_t k = 0; k < count; ++k) {
            const double angle =
                std::numbers::pi * static_cast<double>(k) / static_cast<double>(degree);
            mNodes[k] = 0.5 * (1 - std::cos(angle));
        }
        mNodes.back() = 1;
        // The inverse of the basis's values at the nodes, by elimination with pivots.
        std::vector<std::vector<long double>> rows(count);
        for (std::size_t r = 0; r < count; ++r) {
            rows[r].assign(2 * count, 0);
            rows[r][count + r] = 1;
            for (std::size_t i = 0; i < count; ++i) rows[r][i] = basis(degree, i, mNodes[r]);
        }
        for (std::size_t c = 0; c < count; ++c) {
            std::size_t best = c;
            for (std::size_t r = c; r < count; ++r) {
                if (std::abs(rows[r][c]) > std::abs(rows[best][c])) best = r;
            }
            std::swap(rows[c], rows[best]);
            const long double pivot = rows[c][c];
            for (long double& x : rows[c]) x /= pivot;
            for (std::size_t r = 0; r < count; ++r) {
                const long double factor = rows[r][c];
                if (r == c || factor == 0) continue;
                for (std::size_t k = 0; k < 2 * count; ++k) rows[r][k] -= factor * rows[c][k];
            }
        }
        mInverse.assign(count, std::vector<double>(count));
        for (std::size_t r = 0; r < count; ++r) {
            for (std::size_t k = 0; k < count; ++k) {
                mInverse[r][k] = static_cast<double>(rows[r][count + k]);
            }
        }
    }

    ParameterCurve curveOf(const CurveFunction& function, double from, double to) const {
        const std::size_t count = mNodes.size();
        std::vector<std::array<double, 2>> values;
        for (const double node : mNodes) {
            values.push_back(function(node == 1 ? to : from + node * (to - from)));
        }
        ParameterCurve curve(count, {0, 0});
        for (std::size_t r = 0; r < count; ++r) {
            for (std::size_t k = 0; k < count; ++k) {
                for (std::size_t c = 0; c < 2; ++c) curve[r][c] += mInverse[r][k] * values[k][c];
            }
        }
        curve.front() = values.front();
        curve.back() = values.back();
        return curve;
    }

  private:
    static long double basis(std::size_t degree, std::size_t i, double t) {
        long double value = 1;
        for (std::size_t k = 0; k < i; ++k) {
            value *= static_cast<long double>(degree - k) / static_cast<long double>(k + 1);
            value *= t;
        }
        for (std::size_t k = i; k < degree; ++k) value *= 1 - static_cast<long double>(t);
        return value;
    }

    std::vector<double> mNodes;
    std::vector<std::vector<double>> mInverse;
};

// A polynomial for a part of the curve, and how far it is from it.
struct Fit {
    ParameterCurve curve;
    double from = 0, to = 0;
    double off = 0;
};

// How far a polynomial is from the curve at some places, none of them a node.
double offBetween(const ParameterCurve& curve, const CurveFunction& function, double from,
                  double to) {
    constexpr int kSamples = 13;
    double off = 0;
    for (int k = 1; k < kSamples; ++k) {
        const double t = (k + 0.137) / (kSamples + 0.31);
        const auto a = jetAt(curve, t).place, b = function(from + t * (to - from));
        off = std::max({off, std::abs(a[0] - b[0]), std::abs(a[1] - b[1])});
    }
    return off;
}

// Of the lowest degree that is near enough, else of the one that is nearest.
Fit fitOf(const CurveFunction& function, double from, double to, double tolerance) {
    static const std::array<Interpolation, 3> rising{Interpolation(1), Interpolation(3),
                                                     Interpolation(9)};
    Fit best{.off = std::numeric_limits<double>::infinity()};
    for (const Interpolation& interpolation : rising) {
        Fit fit{interpolation.curveOf(function, from, to), from, to};
        fit.off = offBetween(fit.curve, function, from, to);
        if (fit.off < best.off) best = std::move(fit);
        if (best.off <= tolerance) break;
    }
    return best;
}

}  // namespace

double fitCurve(const CurveFunction& function, double from, double to, double tolerance,
                std::vector<CadPiece>& pieces) {
    const CurveFunction finite = [&](double t) {
        const std::array<double, 2> place = function(t);
        if (std::abs(place[0]) < kFarthest && std::abs(place[1]) < kFarthest) return place;
        throw Error(ErrorKind::Input,
                    "has an edge with a place that is not finite; expected numbers below 1e100");
    };
    const double shortest = kShortest * (to - from);
    std::vector<Fit> fits{fitOf(finite, from, to, tolerance)};
    // Where it turns sharply halves come down to that place, however short.
    while (fits.size() < kMostPieces) {
        Fit* worst = nullptr;
        for (Fit& fit : fits) {
            if (!(fit.off > tolerance) || fit.to - fit.from < shortest) continue;
            if (!worst || fit.off > worst->off) worst = &fit;
        }
        if (!worst) break;
        const double end = worst->to, middle = 0.5 * (worst->from + end);
        *worst = fitOf(finite, worst->from, middle, tolerance);
        fits.push_back(fitOf(finite, middle, end, tolerance));
    }
    std::sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.from < b.from; });
    double off = 0;
    for (Fit& fit : fits) {
        off = std::max(off, fit.off);
        pieces.push_back({std::move(fit.curve), fit.from, fit.to});
    }
    return off;
}

}  // namespace bandvox
