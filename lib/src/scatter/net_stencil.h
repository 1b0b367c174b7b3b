#pragma once

#include "scatter/net_shape.h"
#include "scatter/surface_energy.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace bandvox {

/// A symmetric matrix that joins each control point of a net to those up to three away along x and
/// y: 49 entries a control point, [x][y][7 along x][7 along y].
class NetStencil {
  public:
    static constexpr std::size_t kEntries = 49;

    /// All entries 0.
    explicit NetStencil(std::array<int, 2> points);

    std::array<int, 2> points() const { return mPoints; }
    std::size_t count() const { return mEntries.size() / kEntries; }

    /// The entries of control point `i`, of all the net.
    double* entries(std::size_t i) { return mEntries.data() + i * kEntries; }
    const double* entries(std::size_t i) const { return mEntries.data() + i * kEntries; }

    /// Adds `factor` times the matrix of ∫ |D f|² over the net, margin included; `cellSize`: of the
    /// cells along x and y.
    void addEnergy(const EnergyWeights& weights, double factor, std::array<double, 2> cellSize);

    /// The mean of the diagonal.
    double meanDiagonal() const;

    /// y = A x.
    void multiply(std::span<const double> x, std::span<double> y) const;

    /// One Gauss-Seidel sweep over x for A x = b, from the first colour of rows to the last or
    /// back.
    void relax(std::span<const double> b, std::span<double> x, bool forward) const;

    /// True if each axis with more than one cell has an even number.
    bool canCoarsen() const;
    /// The matrix for the net with cells twice as wide, P^T A P with the two-scale relation P.
    NetStencil coarsened() const;

  private:
    double rowProduct(std::size_t i, std::size_t j, std::span<const double> x) const;

    std::array<int, 2> mPoints;
    std::vector<double> mEntries;
};

/// x = P y: the control points of a surface for cells half as wide along the axes on which `fine`
/// and `coarse`, counts of control points, differ.
void prolongate(std::array<int, 2> coarse, std::array<int, 2> fine, std::span<const double> y,
                std::span<double> x);

/// y = P^T x.
void restrictNet(std::array<int, 2> coarse, std::array<int, 2> fine, std::span<const double> x,
                 std::span<double> y);

/// The sum of a[i] b[i], in an order that does not depend on the number of threads.
double dotProduct(std::span<const double> a, std::span<const double> b);

/// body(begin, end) for pieces of [0, count), in parallel.
template <typename Body>
void forPieces(std::size_t count, std::size_t piece, const Body& body);

}  // namespace bandvox

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cstdint>

namespace bandvox {

template <typename Body>
void forPieces(std::size_t count, std::size_t piece, const Body& body) {
    const std::size_t pieces = (count + piece - 1) / piece;
    if (pieces <= 1) {
        if (count > 0) body(std::size_t(0), count);
        return;
    }
    parallelFor(static_cast<std::int64_t>(pieces), [&](std::int64_t i) {
        const std::size_t begin = static_cast<std::size_t>(i) * piece;
        body(begin, std::min(count, begin + piece));
    });
}

}  // namespace bandvox
