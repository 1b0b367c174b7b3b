#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/fit_surface.h>
#include <bandvox/scatter/scattered_points.h>

namespace bandvox {

/// How the paper's method is run.
struct FilteredFitOptions {
    int levels = 6;           ///< 2^k + 3 control points along each side, k = 1 to this; 1 to 9
    int passes = 30;          ///< of a level, at most; 1 or more
    double tolerance = 1e-6;  ///< a level ends with a pass that changes less, in parts of the range
    /// How far the sample next to a point may differ from its value, in parts of the range: the
    /// distance of samples is halved until none does, or there are 2^finest of them. 0 to 1.
    double closeness = 0.02;
    int finest = 10;  ///< 2^finest samples along each side at most; `levels` + 1 to 12
};

/// Fits a surface as the paper has it, M. Hashimoto, "Smooth Interpolation using Multiresolution
/// Analysis": level by level and pass by pass, what is lacking is interpolated linearly on a
/// Delaunay triangulation of the points, sampled, filtered by a cascade of (1/6, 2/3, 1/6), and
/// interpolated by a spline whose two outermost control points are equal. Samples go through the
/// cascade row by row, and none is kept. Beyond the convex hull they have the values of the nearest
/// places on it, of which the paper does not speak.
///
/// It is the measure for fitSurface, which needs fewer passes and comes nearer. Throws as that
/// does, and Error(ErrorKind::Input) for points on a line, which have no triangles.
SurfaceFit fitByFiltering(const ScatteredPoints& points, const FilteredFitOptions& options = {},
                          Progress& progress = silentProgress());

}  // namespace bandvox
