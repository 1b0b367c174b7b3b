#pragma once

#include <array>
#include <span>

namespace bandvox {

/// A point of a quadrature rule on a triangle: barycentric coordinates, and a weight such that
/// the weights of a rule add up to 1.
struct TrianglePoint {
    double a, b, c;
    double weight;
};

/// The number of symmetric rules on the triangle that are known, by rising degree.
inline constexpr int kTriangleRules = 8;

/// The highest polynomial degree that rule i integrates exactly.
int triangleRuleDegree(int rule);

/// The points of rule i. D. A. Dunavant: "High degree efficient symmetrical Gaussian quadrature
/// rules for the triangle", International Journal for Numerical Methods in Engineering 21 (1985).
std::span<const TrianglePoint> triangleRule(int rule);

/// A point of a Gauss-Legendre rule on [0, 1]; the weights of a rule add up to 1.
struct IntervalPoint {
    double position;
    double weight;
};

/// The number of Gauss-Legendre rules used: rule i has i + 1 points.
inline constexpr int kIntervalRules = 8;

/// The points of the Gauss-Legendre rule with `rule + 1` points.
std::span<const IntervalPoint> intervalRule(int rule);

/// How dense the quadrature points of a surface have to be: for each rule, the largest element
/// on which it is accurate enough. Larger elements are split. Both lists rise.
struct SurfaceQuadrature {
    /// Longest edge of a triangle, voxels.
    std::array<double, kTriangleRules> triangleEdge{};
    /// Longest side of a four-sided cell under the product rule, voxels.
    std::array<double, kIntervalRules> cellSide{};
};

}  // namespace bandvox
