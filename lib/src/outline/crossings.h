#pragma once

#include "outline/curve.h"

#include <span>
#include <vector>

namespace bandvox {

/// Places along a curve as the number of a segment plus a share of it.
using CurvePlaces = std::vector<double>;

/// Where curves may become hidden, or seen: where one passes behind another one on the page that
/// ends or folds a surface, where both are in the same place, and where one ends on another.
std::vector<CurvePlaces> crossings(std::span<const Curve> curves, const CurveSampling& sampling);

}  // namespace bandvox
