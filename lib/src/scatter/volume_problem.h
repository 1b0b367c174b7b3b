#pragma once

#include "scatter/spline_volume_parts.h"

#include <bandvox/scatter/fit_volume.h>
#include <bandvox/scatter/scattered_points.h>

#include <vector>

namespace bandvox {

inline constexpr int kFinestSpaceLevel = 16;

using SpaceColumns = std::vector<std::vector<double>>;  ///< [column][point or control point]

/// Throws Error(ErrorKind::Usage) for options out of range.
void checkVolumeOptions(const FitVolumeOptions& options);

/// Places in a box whose longest side is 1, and values of a mean of 0 and a range of 1 in
/// `columns`, in the order of the sorted points.
SplineVolumeParts makeUnitVolume(const MergedPoints& merged, SpaceColumns& columns);

/// The distance within which most points have another one, in units of the box. `level`: of cells
/// with about a point each.
double spacingOf(const SortedSpacePoints& points, int level,
                 const Progress& progress = silentProgress());

}  // namespace bandvox
