#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/bspline_surface.h>
#include <bandvox/scatter/scattered_points.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace bandvox {

/// How scattered values become a surface.
struct FitSurfaceOptions {
    /// Default: the smallest that holds the points. Points have to lie in it.
    std::optional<Rectangle> rectangle;
    /// How far the surface may be off at a point, in parts of the column's range; 0 to 1. Values at
    /// the same place are averaged if they differ by no more.
    double tolerance = 1e-12;
    /// Above 0: the values have errors of this standard deviation, world units, and the surface is
    /// the smoothest that differs from them by so much in the root of the mean square. 0: none.
    double noise = 0;
    /// The finest level has 2^maxLevel cells along the longer side; 1 to 13. Default: from the
    /// data.
    std::optional<int> maxLevel;
    /// 1 / length, in units of the root of the rectangle's area, 0.01 or more: the surface is stiff
    /// within that length, and like a membrane farther off. Default: the most likely one, or more
    /// if the surface of 20000 points at most would go beyond their values by more than their
    /// range.
    std::optional<double> tension;
};

/// What a level has left.
struct FitLevel {
    int level = 0;               ///< 2^level cells along the longer side
    std::array<int, 2> cells{};  ///< along x and y
    /// Of the differences at the points that this level and those before leave, in parts of the
    /// range; of the last level those of the sum, with its rounding.
    double largest = 0;
    double rms = 0;  ///< their root mean square, the same
};

/// A surface as the sum of surfaces from coarse to fine.
struct SurfaceFit {
    /// Over one rectangle; their cells are levels[i].cells().
    std::vector<BsplineSurface> levels;
    std::vector<FitLevel> report;  ///< one for each
    double tension = 0;            ///< used, as in the options
    /// With a noise: the root mean square of the differences in parts of it; 1 if it was reached.
    double noiseLeft = 1;
    double swing = 0;            ///< how far it goes beyond the values, in parts of their range
    std::size_t points = 0;      ///< after places that are the same became one
    std::size_t duplicates = 0;  ///< how many were averaged away

    /// The sum of the levels with indices from `first` to `last`, both included. Throws
    /// Error(ErrorKind::Usage) if they are not there.
    BsplineSurface sum(std::size_t first, std::size_t last) const;
    BsplineSurface sum() const { return sum(0, levels.size() - 1); }
};

/// Fits a sum of uniform cubic B-spline surfaces, of 2^k + 3 control points along the longer side
/// of the rectangle and cells as square as they can be, to values at scattered points.
///
/// Of all such surfaces with the values, that of least energy: the integral of the squares of the
/// third derivatives, and less of the second and first, over the rectangle and half as much around
/// it, which no turn of the plane changes. So the surface also goes on smoothly where there are no
/// points. The result does not depend on the number of threads. M. Hashimoto, "Smooth Interpolation
/// using Multiresolution Analysis", with another way to each level.
///
/// Throws Error(ErrorKind::Usage) for options out of range, Error(ErrorKind::Input) for points that
/// are not finite, outside the rectangle, all in one place, or in one place with different values,
/// Error(ErrorKind::Interrupted). It is for the caller to see in the report whether the tolerance
/// was reached.
SurfaceFit fitSurface(const ScatteredPoints& points, const FitSurfaceOptions& options = {},
                      Progress& progress = silentProgress());

}  // namespace bandvox
