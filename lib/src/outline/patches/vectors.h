#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bandvox {

/// A place or a direction in the space of the view.
using Vec = std::array<double, 3>;

inline Vec minus(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec plus(const Vec& a, const Vec& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec times(double s, const Vec& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double lengthOf(const Vec& a) {
    return std::sqrt(dot(a, a));
}

/// All directions within an angle of an axis.
struct Cone {
    Vec axis{};                           ///< length 1
    double halfAngle = std::numbers::pi;  ///< π: any direction
    bool isEmpty = true;                  ///< no direction at all

    bool isConvex() const { return halfAngle < 0.5 * std::numbers::pi; }
};

/// The angle between two axes that have no sign, 0 to π/2.
inline double angleBetweenLines(const Vec& a, const Vec& b) {
    return std::acos(std::clamp(std::abs(dot(a, b)), 0.0, 1.0));
}

/// Whether no direction of one cone is one of the other, or its opposite.
inline bool areApart(const Cone& a, const Cone& b) {
    return a.isConvex() && b.isConvex() &&
           angleBetweenLines(a.axis, b.axis) > a.halfAngle + b.halfAngle;
}

/// A cone that holds both.
Cone united(const Cone& a, const Cone& b);

/// The same with all directions turned back.
inline Cone opposite(Cone cone) {
    cone.axis = times(-1, cone.axis);
    return cone;
}

}  // namespace bandvox
