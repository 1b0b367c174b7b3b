#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/scattered_points.h>
#include <bandvox/scatter/spline_volume.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace bandvox {

/// How scattered values in space become a field.
struct FitVolumeOptions {
    /// How far the field may be off at a point, in parts of the column's range; 0 to 1. Values at
    /// the same place are averaged if they differ by no more.
    double tolerance = 1e-12;
    /// Above 0: the values have errors of this standard deviation, world units, and the field is
    /// the smoothest that differs from them by so much in the root of the mean square. 0: none.
    double noise = 0;
    /// The finest level has 2^maxLevel cells along the longest side; 1 to 16. Default: from the
    /// data.
    std::optional<int> maxLevel;
    /// How far from the points the field is there, world units; above 0, 4 times the longest side
    /// of the points' box at most. Default: 4 times the distance within which nine points of ten
    /// have another one, and half of the longest side at most.
    std::optional<double> reach;
    /// 1 / length, in units of the box's longest side, 0.01 to 10000: the field is stiff within
    /// that length, and like a membrane farther off.
    double tension = 2;
};

/// What a level has left.
struct VolumeLevel {
    int level = 0;                  ///< 2^level cells along the longest side
    std::size_t controlPoints = 0;  ///< of its net
    double largest = 0;             ///< of the differences at the points, in parts of the range
    double rms = 0;                 ///< their root mean square, the same
};

struct VolumeFit {
    SplineVolume volume;
    std::vector<VolumeLevel> report;
    double largest = 0, rms = 0;  ///< left in the end, as in the report
    std::size_t points = 0;       ///< after places that are the same became one
    std::size_t duplicates = 0;   ///< how many were averaged away
    bool noiseReached = true;     ///< the field differs by as much as the noise, or there is none
};

/// Fits tensor products of uniform cubic B-splines, of cubic cells, to values at scattered points
/// in space. Control points are there only in reach of the points, so memory follows the data, and
/// not their box.
///
/// Of all such fields with the values, that of least energy: the sum of the squares of third
/// differences of neighbouring control points, and less of second and first ones. Levels are solved
/// from the coarsest on, each by conjugate gradients; where points are nearer to each other than
/// the cells are wide, finer nets around them take the rest, and what is left then is taken by
/// bumps at the points. The result does not depend on the number of threads.
///
/// Throws Error(ErrorKind::Usage) for options out of range and points in a plane,
/// Error(ErrorKind::Input) for points that are not finite, all in one place, or in one place with
/// different values, Error(ErrorKind::Memory), Error(ErrorKind::Interrupted). It is for the caller
/// to see whether the tolerance was reached.
VolumeFit fitVolume(const ScatteredPoints& points, const FitVolumeOptions& options = {},
                    Progress& progress = silentProgress());

}  // namespace bandvox
