#pragma once

#include <bandvox/source/face_topology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace bandvox {

/// A point of a parameter curve, and the derivative by the curve's parameter.
struct ParameterJet {
    std::array<double, 2> place{}, slope{};
};

/// At t, 0 to 1, by de Casteljau's scheme.
inline ParameterJet jetAt(const ParameterCurve& curve, double t) {
    constexpr std::size_t kFew = 16;
    std::array<ParameterCurve::value_type, kFew> few;
    ParameterCurve many;
    if (curve.size() > kFew) many = curve;
    ParameterCurve::value_type* const points = many.empty() ? few.data() : many.data();
    if (many.empty()) std::copy(curve.begin(), curve.end(), points);
    const std::size_t degree = curve.size() - 1;
    ParameterJet jet;
    for (std::size_t rest = degree; rest > 0; --rest) {
        if (rest == 1) {
            for (std::size_t c = 0; c < 2; ++c) {
                jet.slope[c] = static_cast<double>(degree) * (points[1][c] - points[0][c]);
            }
        }
        for (std::size_t i = 0; i < rest; ++i) {
            for (std::size_t c = 0; c < 2; ++c) {
                points[i][c] = (1 - t) * points[i][c] + t * points[i + 1][c];
            }
        }
    }
    jet.place = points[0];
    return jet;
}

/// The parts of a curve before and after t, which end and begin in the same numbers.
inline std::pair<ParameterCurve, ParameterCurve> divided(ParameterCurve points, double t) {
    const std::size_t degree = points.size() - 1;
    ParameterCurve low{points.front()}, high(points.size());
    high[degree] = points.back();
    for (std::size_t rest = degree; rest > 0; --rest) {
        for (std::size_t i = 0; i < rest; ++i) {
            for (std::size_t c = 0; c < 2; ++c) {
                points[i][c] = (1 - t) * points[i][c] + t * points[i + 1][c];
            }
        }
        low.push_back(points[0]);
        high[rest - 1] = points[rest - 1];
    }
    return {std::move(low), std::move(high)};
}

/// The part from t0 to t1.
inline ParameterCurve partOf(const ParameterCurve& curve, double t0, double t1) {
    if (t1 <= 0) return ParameterCurve(curve.size(), curve.front());
    const ParameterCurve low = t1 < 1 ? divided(curve, t1).first : curve;
    return t0 > 0 ? divided(low, t0 / t1).second : low;
}

/// A rectangle of parameters.
struct ParameterBox {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};

    void expand(const std::array<double, 2>& p) {
        for (std::size_t c = 0; c < 2; ++c) {
            low[c] = std::min(low[c], p[c]);
            high[c] = std::max(high[c], p[c]);
        }
    }
    bool meets(const ParameterBox& other) const {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
               other.low[1] <= high[1];
    }
};

/// The box of the control points, which holds the curve.
inline ParameterBox boxOf(const ParameterCurve& curve) {
    ParameterBox box;
    for (const auto& p : curve) box.expand(p);
    return box;
}

/// Of a polynomial with these coefficients in Bernstein's basis on [0, 1]: appends its roots
/// between, ascending, at which it changes its sign. Two that are closer than 1e-12 may be left
/// out.
inline void appendSignChanges(std::vector<double> c, double from, double to,
                              std::vector<double>& roots) {
    int changes = 0;
    for (std::size_t i = 1; i < c.size(); ++i) changes += (c[i] >= 0) != (c[i - 1] >= 0);
    if (changes == 0) return;
    const auto halve = [](std::vector<double>& low, double t) {
        std::vector<double> high(low.size());
        const std::size_t degree = low.size() - 1;
        std::vector<double> first{low[0]};
        high[degree] = low[degree];
        for (std::size_t rest = degree; rest > 0; --rest) {
            for (std::size_t i = 0; i < rest; ++i) low[i] = (1 - t) * low[i] + t * low[i + 1];
            first.push_back(low[0]);
            high[rest - 1] = low[rest - 1];
        }
        low = std::move(first);
        return high;
    };
    if (changes == 1) {
        // One root: a line has it at once, else by halves, and the last steps by the secant.
        while (to - from > 1e-9 && c.size() > 2) {
            std::vector<double> high = halve(c, 0.5);
            const double middle = 0.5 * (from + to);
            const bool isLow = (c.front() >= 0) != (c.back() >= 0);
            if (!isLow) c = std::move(high);
            (isLow ? to : from) = middle;
        }
        const double step = c.front() - c.back();
        const double share = step != 0 ? std::clamp(c.front() / step, 0.0, 1.0) : 0.5;
        roots.push_back(from + share * (to - from));
        return;
    }
    if (to - from < 1e-12) {
        if (changes % 2 == 1) roots.push_back(0.5 * (from + to));
        return;
    }
    const double middle = 0.5 * (from + to);
    std::vector<double> high = halve(c, 0.5);
    appendSignChanges(std::move(c), from, middle, roots);
    appendSignChanges(std::move(high), middle, to, roots);
}

/// The parameters, ascending, at which a curve crosses the line where coordinate `axis` is `value`.
inline std::vector<double> crossingsOf(const ParameterCurve& curve, std::size_t axis,
                                       double value) {
    std::vector<double> c, roots;
    c.reserve(curve.size());
    for (const auto& p : curve) c.push_back(p[axis] - value);
    appendSignChanges(std::move(c), 0, 1, roots);
    return roots;
}

/// The parameters, ascending, at which coordinate `axis` of a curve turns back.
inline std::vector<double> turnsOf(const ParameterCurve& curve, std::size_t axis) {
    std::vector<double> slopes, roots;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        slopes.push_back(curve[i][axis] - curve[i - 1][axis]);
    }
    appendSignChanges(std::move(slopes), 0, 1, roots);
    return roots;
}

}  // namespace bandvox
