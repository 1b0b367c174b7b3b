#pragma once

#include "source/cad_shape.h"

#include <array>
#include <functional>
#include <vector>

namespace bandvox {

/// A curve in parameters, by its own parameter.
using CurveFunction = std::function<std::array<double, 2>(double)>;

/// Polynomials that are a function from `from` to `to` but for `tolerance`: of degree 1, 3 or 9, on
/// as many halves as that takes, up to 1024, and those not shorter than 1e-7 of the whole. Appends
/// them; their ends in `pieces` are in the function's parameter. Returns how far they are from the
/// function, which may be more than `tolerance`. Throws Error(ErrorKind::Input), which does not
/// name the file, if a place is not finite or 1e100 and more.
double fitCurve(const CurveFunction& function, double from, double to, double tolerance,
                std::vector<CadPiece>& pieces);

}  // namespace bandvox
