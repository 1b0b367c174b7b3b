#pragma once

#include "scatter/net_points.h"
#include "scatter/sparse_rows.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// What a net without a margin has to add so that points get the values they lack: of all the nets
/// that do, the one whose control points are least in the sum of squares. Where cells are narrower
/// than the points are apart, each point thus gets a small bump of its own.
class ResidualMender {
  public:
    /// Keeps a reference to the points.
    ResidualMender(const SortedPoints& points, const NetShape& shape);

    /// Whether so many points are within three cells of one that there is no telling them apart:
    /// then it is of no use, and the memory of their products was not taken.
    bool isCrowded() const { return mIsCrowded; }

    /// The multipliers of the points' splines whose sum takes the values `lacking`, up to `enough`
    /// at any point, if so many steps do. Throws Error(ErrorKind::Interrupted).
    std::vector<double> multipliers(std::span<const double> lacking, double enough, int steps,
                                    Progress& progress) const {
        return solveSparseRows(mProducts, lacking, enough, steps, progress);
    }

    /// Adds the bumps to a net.
    void addTo(std::span<double> net, std::span<const double> multipliers) const {
        mNetPoints.spread(multipliers, net);
    }

  private:
    NetPoints mNetPoints;
    SparseRows mProducts;  // of the points' splines
    bool mIsCrowded = false;
};

}  // namespace bandvox
