#pragma once

#include <bandvox/source/bspline_patch.h>

namespace bandvox {

/// The shortest stretch between knots that counts, as a part of the range of parameters.
constexpr double kLeastSpan = 1e-9;

/// Makes knots that are nearer to each other than kLeastSpan of the range one knot of so many
/// times: where a file means one, rounding is not to make a patch that is as good as a line. Ends
/// of the range stay. The net has to have as many knots as it needs.
///
/// Only a stretch on which the surface hardly moves is joined: one as short beside each of the
/// degree + 1 knots in a row around it. So at most `degree` near knots become one; where more are
/// near, the surface moves from one control point to another between them, and they stay. Knots
/// that only the rounding of doubles tells apart are one in any number: more than `degree` of them
/// cut the surface in two, as they do where they are equal.
void joinNearKnots(BsplineNet& net);

}  // namespace bandvox
