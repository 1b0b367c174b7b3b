#pragma once

#include <bandvox/scatter/bspline_surface.h>
#include <bandvox/scatter/scattered_points.h>

#include <vector>

namespace bandvox {

/// How far the sum of surfaces over one rectangle goes beyond the values of points, in parts of
/// their column's range: the most of all columns, at places of a grid.
double swingOf(const std::vector<BsplineSurface>& levels, const ScatteredPoints& points);

}  // namespace bandvox
