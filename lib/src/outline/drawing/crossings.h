#pragma once

#include "outline/drawing/curve_scene.h"

#include <span>
#include <vector>

namespace bandvox {

/// Places along a curve as the number of a segment plus a share of it.
using CurvePlaces = std::vector<double>;

/// Where curves may become hidden, or seen: where one passes behind another one on the page that
/// ends or folds a surface, where both are in the same place, where one ends on another, and where
/// an intersection or an isophote goes over a fold: there both touch on the page and do not cross.
std::vector<CurvePlaces> crossings(std::span<const Curve> curves, CurveReader& reader,
                                   const CurveSampling& sampling);

}  // namespace bandvox
