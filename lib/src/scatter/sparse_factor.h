#pragma once

#include "scatter/net_stencil.h"

#include <memory>
#include <span>

namespace bandvox {

/// The Cholesky factor of a net's matrix, for nets of some ten thousand control points.
class SparseFactor {
  public:
    /// Throws Error(ErrorKind::Runtime) if the matrix is not positive definite.
    explicit SparseFactor(const NetStencil& stencil);
    ~SparseFactor();
    SparseFactor(SparseFactor&&) noexcept;
    SparseFactor& operator=(SparseFactor&&) noexcept;

    /// x = A^-1 b. By many threads at once.
    void solve(std::span<const double> b, std::span<double> x) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> mImplementation;
};

/// A symmetric matrix, [row][column], and its eigenvalues from the lowest.
struct DenseSymmetric {
    std::vector<double> entries;
    std::vector<double> eigenvalues;
};

/// The inverse of a symmetric positive definite matrix, less 1 on the diagonal.
DenseSymmetric inverseLessOne(std::span<const double> entries, std::size_t size);

}  // namespace bandvox
