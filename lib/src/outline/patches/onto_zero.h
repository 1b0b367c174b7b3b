#pragma once

#include "outline/patches/bernstein.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

/// Moves parameters of a patch onto where a function of them is 0, along its gradient, or along a
/// border that would be left, by Newton's method. `functionAt(u, v)` gives a Gradient2; values of
/// at most `rounding` are as good as 0. False if they are still moving in the end, or if there is
/// no gradient: then they may be anywhere.
template <class Function>
bool ontoZero(const Function& functionAt, double& u, double& v, double rounding = 0) {
    constexpr int kMostSteps = 12;
    constexpr double kNear = 1e-9;  // each step squares the error
    const auto leaves = [](double t, double move) {
        return (t <= 0 && move < 0) || (t >= 1 && move > 0);
    };
    for (int step = 0; step < kMostSteps; ++step) {
        Gradient2 f = functionAt(u, v);
        if (std::abs(f.value) <= rounding) return true;
        if (leaves(u, -f.value * f.du)) f.du = 0;
        if (leaves(v, -f.value * f.dv)) f.dv = 0;
        const double square = f.du * f.du + f.dv * f.dv;
        if (!(square > 0)) return f.value == 0;
        const double du = -f.value * f.du / square, dv = -f.value * f.dv / square;
        u = std::clamp(u + du, 0.0, 1.0);
        v = std::clamp(v + dv, 0.0, 1.0);
        if (std::max(std::abs(du), std::abs(dv)) < kNear) return true;
    }
    return false;
}

}  // namespace bandvox
