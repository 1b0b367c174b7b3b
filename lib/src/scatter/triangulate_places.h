#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace bandvox {

/// The Delaunay triangulation of places of a plane that are all different: indices,
/// counter-clockwise. None if the places are on a line. By CGAL, with exact predicates.
std::vector<std::array<std::size_t, 3>> triangulatePlaces(std::span<const double> x,
                                                          std::span<const double> y);

}  // namespace bandvox
