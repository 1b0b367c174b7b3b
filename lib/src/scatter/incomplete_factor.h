#pragma once

#include "scatter/sparse_rows.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// The incomplete Cholesky factor of blocks on the diagonal of a positive definite matrix, without
/// entries where the matrix has none. What two rows in a block have nearly in common it resolves,
/// which scaling by the diagonal does not.
class IncompleteFactor {
  public:
    /// Keeps a reference to the matrix's shape.
    explicit IncompleteFactor(const SparseRows& matrix);

    /// y = M^-1 x.
    void solve(std::span<const double> x, std::span<double> y) const;

  private:
    void factorRow(std::size_t row, std::size_t first);

    const SparseRows& mMatrix;
    std::vector<double> mEntry;            // of the factor, where the matrix's are
    std::vector<std::uint32_t> mBegin;     // of each row's entries in its block, after its start
    std::vector<std::uint32_t> mDiagonal;  // after its start
};

}  // namespace bandvox
