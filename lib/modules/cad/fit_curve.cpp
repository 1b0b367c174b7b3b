#include "fit_curve.h"

#include "source/parameter_curve.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace bandvox {
namespace {

constexpr int kMostHalvings = 10;

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

bool isNear(const ParameterCurve& curve, const CurveFunction& function, double from, double to,
            double tolerance) {
    constexpr int kSamples = 13;  // none of them a node
    for (int k = 1; k < kSamples; ++k) {
        const double t = (k + 0.137) / (kSamples + 0.31);
        const auto a = jetAt(curve, t).place, b = function(from + t * (to - from));
        if (std::abs(a[0] - b[0]) > tolerance || std::abs(a[1] - b[1]) > tolerance) return false;
    }
    return true;
}

void fitPart(const CurveFunction& function, double from, double to, double tolerance, int depth,
             std::vector<CadPiece>& pieces) {
    static const std::array<Interpolation, 3> rising{Interpolation(1), Interpolation(3),
                                                     Interpolation(9)};
    ParameterCurve curve;
    for (const Interpolation& interpolation : rising) {
        curve = interpolation.curveOf(function, from, to);
        if (!isNear(curve, function, from, to, tolerance)) continue;
        pieces.push_back({std::move(curve), from, to});
        return;
    }
    if (depth == kMostHalvings) {
        pieces.push_back({std::move(curve), from, to});
        return;
    }
    const double middle = 0.5 * (from + to);
    fitPart(function, from, middle, tolerance, depth + 1, pieces);
    fitPart(function, middle, to, tolerance, depth + 1, pieces);
}

}  // namespace

void fitCurve(const CurveFunction& function, double from, double to, double tolerance,
              std::vector<CadPiece>& pieces) {
    fitPart(function, from, to, tolerance, 0, pieces);
}

}  // namespace bandvox
