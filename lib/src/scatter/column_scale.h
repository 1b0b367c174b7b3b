#pragma once

#include <bandvox/scatter/scattered_points.h>

namespace bandvox {

/// What a column's values are about, and how far apart they are.
struct ColumnScale {
    double mean = 0;
    double range = 1;  ///< 1 if all are the same
};

/// Throws Error(ErrorKind::Input) if the range is no number.
ColumnScale scaleOfColumn(const ScatteredPoints& points, int column);

}  // namespace bandvox
