#pragma once

#include "outline/drawing/curve.h"

#include <array>
#include <vector>

namespace bandvox {

/// Cubic Bézier curves through a curve's ends and corners, with its directions there, that are
/// nowhere farther from its points than `tolerance`, page units: as few as can be found, of about
/// the same error. Returns anchors and handles as OutlinePath has them.
///
/// After section 2.1.2 of "Vector rendering of free-form surfaces": least squares, and splitting.
/// Parameters are lengths along the curve, improved by projecting (M. Plass and M. Stone,
/// "Curve-fitting with piecewise parametric cubics", 1983), and directions at the ends are the true
/// ones, so that the pieces join smoothly.
std::vector<std::array<double, 2>> fitCubics(const Curve& curve, double tolerance);

}  // namespace bandvox
