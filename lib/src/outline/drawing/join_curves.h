#pragma once

#include "outline/drawing/curve.h"

#include <vector>

namespace bandvox {

/// Joins curves of one kind where their ends are in the same place; where more than two meet, those
/// that go on most smoothly. Marks what is a corner. Curves shorter than rounding are left out.
std::vector<Curve> joinCurves(std::vector<Curve> curves, const CurveSampling& sampling);

/// The direction in which a curve leaves point `at` towards point `to`, length 1.
std::array<double, 2> directionTowards(const CurvePoint& at, const CurvePoint& to);

}  // namespace bandvox
