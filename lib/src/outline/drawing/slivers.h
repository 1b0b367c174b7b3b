#pragma once

#include "outline/drawing/curve.h"

#include <vector>

namespace bandvox {

/// Leaves away what has no width on the page: closed curves whose image goes there and back within
/// `width`, page units, of the same way, and the middle one of three parts of a curve, from corner
/// to corner, that go there, back and there again. They come from what is seen edge-on and is as
/// flat as is known, where it is chance on which side the eye is.
std::vector<Curve> withoutSlivers(std::vector<Curve> curves, double width);

}  // namespace bandvox
