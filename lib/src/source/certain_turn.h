#pragma once

#include <openvdb/Types.h>

#include <cmath>

namespace bandvox {

/// Two coordinates of three, in which triangles are looked at along the third.
struct View2 {
    int u, v;
};

/// What is left of three coordinates without one of them, so that a triangle whose normal has a
/// positive part along that axis turns left.
inline View2 viewAlong(int axis) {
    return {(axis + 1) % 3, (axis + 2) % 3};
}

/// 1 if a, b, c turn left in a view, -1 if they turn right, 0 if rounding may have decided.
/// J. R. Shewchuk: "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates" (1997), the first bound of orient2d.
inline int certainTurn(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
                       View2 view) {
    constexpr double kRounding = 3.4e-16;  // (3 + 16 ε) ε, and a little
    constexpr double kUnderflow = 1e-300;  // far more than products that underflow lose
    const double left = (b[view.u] - a[view.u]) * (c[view.v] - a[view.v]);
    const double right = (b[view.v] - a[view.v]) * (c[view.u] - a[view.u]);
    const double bound = kRounding * (std::abs(left) + std::abs(right)) + kUnderflow;
    const double turn = left - right;
    return (turn > bound ? 1 : 0) - (turn < -bound ? 1 : 0);
}

}  // namespace bandvox
