#include "outline/patches/vectors.h"

namespace bandvox {

Cone united(const Cone& a, const Cone& b) {
    if (a.isEmpty) return b;
    if (b.isEmpty) return a;
    Cone both;
    both.isEmpty = false;
    const Vec sum = plus(a.axis, b.axis);
    const double length = lengthOf(sum);
    if (!(length > 1e-6)) return both;
    both.axis = times(1 / length, sum);
    const auto reach = [&](const Cone& c) {
        return std::acos(std::clamp(dot(c.axis, both.axis), -1.0, 1.0)) + c.halfAngle;
    };
    both.halfAngle = std::min(std::numbers::pi, std::max(reach(a), reach(b)));
    return both;
}

}  // namespace bandvox
