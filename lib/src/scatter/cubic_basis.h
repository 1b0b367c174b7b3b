#pragma once

#include <algorithm>
#include <array>

namespace bandvox {

/// Where a coordinate lies among the knots 0, 1, ..., `cells`: the first of the four control points
/// that count there, and the place in the cell, 0 to 1. Outside, the first or last cell goes on;
/// what is no number has a place that is none.
struct KnotPlace {
    int cell;
    double place;
};

inline KnotPlace findCell(double knot, int cells) {
    const int cell = knot > 0 ? static_cast<int>(std::min(knot, cells - 1.0)) : 0;
    return {cell, knot - cell};
}

/// The four uniform cubic B-splines that are not 0 in a cell, at t = 0 to 1 in it; their derivative
/// of order 1, 2 or 3 by t.
inline std::array<double, 4> cubicWeights(double t, int derivative = 0) {
    const double s = 1 - t;
    switch (derivative) {
        case 0:
            return {s * s * s / 6, (4 + t * t * (3 * t - 6)) / 6, (4 + s * s * (3 * s - 6)) / 6,
                    t * t * t / 6};
        case 1:
            return {-s * s / 2, t * (1.5 * t - 2), s * (2 - 1.5 * s), t * t / 2};
        case 2:
            return {s, 3 * t - 2, 3 * s - 2, t};
        default:
            return {-1, 3, -3, 1};
    }
}

/// Control point I of a cubic B-spline is spread over 2 I - 3 + a, a = 0 to 4, of the one with
/// cells half as wide. C. K. Chui, "An Introduction to Wavelets", 1992: the two-scale relation.
inline constexpr std::array<double, 5> kTwoScale{0.125, 0.5, 0.75, 0.5, 0.125};

}  // namespace bandvox
