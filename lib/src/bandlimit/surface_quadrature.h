#pragma once

#include <bandvox/source/quadrature.h>
#include <bandvox/spectral/exponential_filter.h>

namespace bandvox {

/// How dense the quadrature points of a surface must be, so that the filtered density is hardly
/// ever wrong by more than `tolerance` because of them.
///
/// Each rule's error on plane waves is taken as noise that is independent from element to
/// element; what of it passes the filter has a standard deviation, and five of those are
/// allowed. docs/math/exact-route.md derives it.
SurfaceQuadrature chooseQuadrature(const ExponentialFilter& filter, double tolerance);

}  // namespace bandvox
