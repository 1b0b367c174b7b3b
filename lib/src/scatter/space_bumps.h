#pragma once

#include "scatter/space_points.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// The height of a bump at an offset from its point: a product of three cubic B-splines, 1 at 0,
/// and 0 where a coordinate is `radius` off or more.
double bumpHeight(const std::array<double, 3>& offset, double radius);

/// Its gradient there.
std::array<double, 3> bumpGradient(const std::array<double, 3>& offset, double radius);

/// Bumps at all points that together have given values there.
class SpaceBumps {
  public:
    /// Bumps of the radius of a cell's side. Keeps a reference to the points.
    SpaceBumps(const SortedSpacePoints& points, int level);

    /// Pairs of points whose bumps meet.
    std::size_t meetings() const { return mOthers.size(); }

    /// The sizes that give the points these values, by conjugate gradients, until none is off by
    /// more than `tolerance`, or so many steps.
    std::vector<double> sizes(std::span<const double> values, double tolerance, int steps,
                              Progress& progress) const;

    /// values = what bumps of such sizes have at the points.
    void evaluate(std::span<const double> sizes, std::span<double> values) const;

  private:
    std::vector<std::size_t> mStart;     // of each point's others
    std::vector<std::uint32_t> mOthers;  // whose bumps it is in, but for its own
    std::vector<double> mHeights;        // of these at the point
};

/// How often points have another one in their own cell.
double sharedCells(const SortedSpacePoints& points, const OccupiedCells& cells);

}  // namespace bandvox
