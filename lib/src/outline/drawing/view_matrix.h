#pragma once

#include <array>

namespace bandvox {

/// The view as a projective map: rows that turn (x, y, z, 1), world, into (wX, wY, wZ, w), where X
/// and Y are a place of the page, from its upper left corner, and Z grows with the depth. So all
/// lines of sight are parallel to the axis of Z, under perspective too.
using ViewMatrix = std::array<std::array<double, 4>, 4>;

}  // namespace bandvox
