#pragma once

#include "scatter/incomplete_factor.h"
#include "scatter/net_points.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// How many points are at most up to three cells away from one, itself included.
std::size_t mostNeighbors(const SortedPoints& points, const NetShape& shape);

/// What a net without a margin has to add so that points get the values they lack: of all the nets
/// that do, the one whose control points are least in the sum of squares. Where cells are narrower
/// than the points are apart, each point thus gets a small bump of its own.
class ResidualMender {
  public:
    /// Keeps a reference to the points.
    ResidualMender(const SortedPoints& points, const NetShape& shape);

    /// The multipliers of the points' splines whose sum takes the values `lacking`, up to `enough`
    /// at any point, if so many steps do. Throws Error(ErrorKind::Interrupted).
    std::vector<double> multipliers(std::span<const double> lacking, double enough, int steps,
                                    Progress& progress) const;

    /// Adds the bumps to a net.
    void addTo(std::span<double> net, std::span<const double> multipliers) const {
        mNetPoints.spread(multipliers, net);
    }

  private:
    static SparseRows multiplyNeighbors(const SortedPoints& points, const NetPoints& net);
    void multiply(std::span<const double> x, std::span<double> y) const;

    NetPoints mNetPoints;
    SparseRows mProducts;  // of the points' splines
};

}  // namespace bandvox
