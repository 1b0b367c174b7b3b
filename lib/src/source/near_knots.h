#pragma once

#include <bandvox/source/bspline_patch.h>

namespace bandvox {

/// The shortest stretch between knots that counts, as a part of the range of parameters.
constexpr double kLeastSpan = 1e-9;

/// Makes knots that are nearer to each other than kLeastSpan of the range one knot of so many
/// times: where a file means one, rounding is not to make a patch that is as good as a line. Ends
/// of the range stay. The net has to have as many knots as it needs.
void joinNearKnots(BsplineNet& net);

}  // namespace bandvox
