#pragma once

#include <bandvox/core/progress.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// A symmetric matrix by rows; the neighbours of a row rise, and hold the row itself.
struct SparseRows {
    std::vector<std::size_t> start{0};
    std::vector<std::uint32_t> neighbor;
    std::vector<double> entry;

    std::size_t size() const { return start.size() - 1; }

    /// y = A x.
    void multiply(std::span<const double> x, std::span<double> y) const;
};

/// The x for which no entry of `right` - A x is above `enough`, A positive definite, as near as so
/// many steps come: conjugate gradients with an incomplete Cholesky factor. Once few rows lack
/// something they and their surroundings are solved alone, so that a crowd of nearly equal rows
/// does not cost steps of the whole. Throws Error(ErrorKind::Interrupted).
std::vector<double> solveSparseRows(const SparseRows& matrix, std::span<const double> right,
                                    double enough, int steps, Progress& progress);

}  // namespace bandvox
