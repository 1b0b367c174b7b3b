#pragma once

#include "scatter/space_energy.h"
#include "scatter/space_points.h"

#include <bandvox/core/progress.h>

#include <functional>
#include <vector>

namespace bandvox {

/// A net and the coarser ones that hold its parents, from the coarsest on.
struct SpaceNets {
    std::vector<SpaceNet> nets;
    int finest = 0;  ///< the level of the last one

    int coarsest() const { return finest + 1 - static_cast<int>(nets.size()); }
    const SpaceNet& ofLevel(int level) const {
        return nets[static_cast<std::size_t>(level - coarsest())];
    }
};

SpaceNets makeSpaceNets(SpaceNet finest, int level, int coarsest,
                        const Progress& progress = silentProgress());

/// Solves (A^T W A + E) c = b on a sparse net by conjugate gradients. What precedes a step is the
/// sum over the levels of each diagonal's inverse, which takes about as many steps for every size.
/// J. H. Bramble, J. E. Pasciak, J. Xu, "Parallel Multilevel Preconditioners", 1990.
class SpaceSolver {
  public:
    /// Of one of the levels. `tension` in units of the box's longest side; `stiffness` 1 gives a
    /// control point about as much energy as a point has weight. Keeps references to the nets and
    /// the points.
    SpaceSolver(const SpaceNets& nets, int level, const SortedSpacePoints& points, double tension,
                double stiffness);

    const SpacePoints& points() const { return mPoints; }

    struct Stop {
        double reduction = 1e-4;  ///< of the residual's norm
        int steps = 300;
    };
    /// Improves x. Returns the number of steps.
    int solve(std::span<const double> b, std::span<double> x, const Stop& stop,
              Progress& progress) const;

  private:
    void multiply(std::span<const double> x, std::span<double> y) const;
    void precondition(std::span<const double> residual, std::span<double> result) const;

    const SpaceNets& mNets;
    int mLevel;
    SpacePoints mPoints;
    SpaceEnergy mEnergy;
    std::vector<std::vector<double>> mInverse;  // of the diagonals, from the coarsest level on
};

}  // namespace bandvox
