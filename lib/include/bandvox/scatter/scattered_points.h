#pragma once

#include <bandvox/scatter/bspline_surface.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bandvox {

/// Values at places in a plane or in space, in any order.
struct ScatteredPoints {
    std::vector<double> x, y;        ///< world units, finite
    std::vector<double> z;           ///< the same; empty in a plane
    int columns = 1;                 ///< values at each place, 1 or more
    std::vector<double> values;      ///< [place][column], finite
    std::vector<std::string> names;  ///< of the columns; may be empty
    /// Where each stands in the file that it comes from, for errors; may be empty.
    std::vector<std::uint32_t> lines;
    std::string lineWord = "line";  ///< what the file has: lines, or rows

    bool isInSpace() const { return !z.empty(); }

    std::size_t size() const { return x.size(); }
    double value(std::size_t i, int column) const {
        return values[i * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
    }
};

/// Places that are all different.
struct MergedPoints {
    ScatteredPoints points;
    std::vector<double> weight;  ///< of each: how many have become one
    std::size_t duplicates = 0;  ///< how many are gone
};

/// " (line 7)" of a point, or nothing if its line is not known.
std::string lineOfPoint(const ScatteredPoints& points, std::size_t i);

/// Averages the values at places that are the same. Throws Error(ErrorKind::Input) if such values
/// are farther apart than `tolerance` times the range of their column; a negative tolerance allows
/// any. Throws Error(ErrorKind::Usage) if the sizes do not fit, Error(ErrorKind::Input) for numbers
/// that are not finite.
MergedPoints mergeDuplicates(const ScatteredPoints& points, double tolerance);

/// The smallest rectangle that holds the points; a side that would be shorter than 1/1024 of the
/// other, as of points on a line along an axis, is widened to that.
/// Throws Error(ErrorKind::Input) if the points are all in one place or none are there.
Rectangle boundingRectangle(const ScatteredPoints& points);

}  // namespace bandvox
