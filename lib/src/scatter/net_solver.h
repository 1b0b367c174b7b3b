#pragma once

#include "scatter/net_stencil.h"
#include "scatter/sparse_factor.h"

#include <bandvox/core/progress.h>

#include <optional>
#include <span>
#include <vector>

namespace bandvox {

/// Solves with the matrix of a net: small ones by their Cholesky factor, others by conjugate
/// gradients, each step of which is improved by one round of multigrid.
class NetSolver {
  public:
    /// The largest net that is factored, control points.
    static constexpr std::size_t kLargestFactored = 28000;

    /// The largest net that always is.
    static constexpr std::size_t kSmallEnough = 3000;

    /// Nets that many points hold everywhere are solved sooner by steps than by factors: see
    /// kSmallEnough.
    explicit NetSolver(NetStencil stencil, std::size_t largestFactored = kLargestFactored);

    const NetStencil& stencil() const { return mLevels.front(); }

    struct Stop {
        double reduction = 1e-8;  ///< of the residual, as multigrid measures it
        int steps = 200;          ///< the most
    };

    /// Makes `x`, from what it is, the solution of A x = b. Returns how many steps were taken.
    /// Throws Error(ErrorKind::Interrupted).
    int solve(std::span<const double> b, std::span<double> x, const Stop& stop,
              Progress& progress = silentProgress()) const;

  private:
    void cycle(std::size_t level, std::span<const double> b, std::span<double> x) const;

    std::vector<NetStencil> mLevels;      // from the finest
    std::optional<SparseFactor> mFactor;  // of the coarsest
};

}  // namespace bandvox
