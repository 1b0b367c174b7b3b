#pragma once

#include "source/cad_shape.h"

#include <array>
#include <functional>
#include <vector>

namespace bandvox {

/// A curve in parameters, by its own parameter.
using CurveFunction = std::function<std::array<double, 2>(double)>;

/// Polynomials that are a smooth function from `from` to `to` but for `tolerance`: of degree 1, 3
/// or 9 on as many halves as that takes. Appends them; their ends in `pieces` are in the function's
/// parameter.
void fitCurve(const CurveFunction& function, double from, double to, double tolerance,
              std::vector<CadPiece>& pieces);

}  // namespace bandvox
