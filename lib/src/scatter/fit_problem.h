#pragma once

#include "scatter/net_points.h"
#include "scatter/net_solver.h"

#include <bandvox/scatter/fit_surface.h>

#include <array>
#include <span>
#include <vector>

namespace bandvox {

/// Points on the unit square, and values of a mean of 0 and a range of 1.
struct UnitPoints {
    SortedPoints points;
    std::vector<std::vector<double>> values;  ///< [column][point]
    std::vector<double> mean, range;          ///< of each column, world units
    Rectangle rectangle;
    std::array<double, 2> side{1, 1};  ///< of the rectangle, in units of the root of its area
};

/// Throws Error(ErrorKind::Usage) for options out of range.
void checkFitOptions(const FitSurfaceOptions& options);

/// Throws Error(ErrorKind::Input) for points outside the rectangle.
void checkInside(const ScatteredPoints& points, const Rectangle& r);

UnitPoints makeUnitPoints(const MergedPoints& merged, const Rectangle& rectangle);

/// The net of a level: its cells are as square as they can be.
NetShape shapeOfLevel(int level, std::array<double, 2> side, bool withMargin);

/// The matrix of the points' squares, and `stiffness` times that of the energy: a stiffness of 1
/// gives a control point about as much energy as a point has weight.
NetStencil makeNormalStencil(const NetPoints& points, std::array<double, 2> side, double tension,
                             double stiffness);

/// How many cells side by side are as long as the places of most points are apart, as log2.
int levelOfPoints(const UnitPoints& unit);

/// The tension that makes the values most likely, or the least of those that are nearly as likely.
double chooseTension(const UnitPoints& unit, Progress& progress);

}  // namespace bandvox
