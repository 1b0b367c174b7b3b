#pragma once

#include "scatter/cubic_basis.h"
#include "scatter/net_shape.h"
#include "scatter/net_stencil.h"

#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// Points of the unit square in an order in which neighbours are close in memory.
struct SortedPoints {
    /// The most cells along a side of the square that such an order serves.
    static constexpr int kMostCells = 1 << 13;

    std::vector<double> u, v;           ///< 0 to 1
    std::vector<double> weight;         ///< above 0; how many points each stands for
    std::vector<std::uint32_t> origin;  ///< the index that each had before

    std::size_t size() const { return u.size(); }
};

/// Sorts points by strips of u, and by v in a strip.
SortedPoints sortPoints(std::span<const double> u, std::span<const double> v,
                        std::span<const double> weight);

/// How points act on a net, and the net on them.
class NetPoints {
  public:
    /// Keeps a reference to the points.
    NetPoints(const SortedPoints& points, const NetShape& shape);

    const NetShape& shape() const { return mShape; }
    std::size_t size() const { return mPoints.size(); }

    /// values = A c: the surface at each point.
    void evaluate(std::span<const double> net, std::span<double> values) const;

    /// net += A^T values.
    void spread(std::span<const double> values, std::span<double> net) const;

    /// stencil += A^T W A, W the points' weights.
    void addNormal(NetStencil& stencil) const;

    /// Where a point lies: the first of its control points, and the weights along x and y.
    struct Place {
        std::size_t first;
        std::array<double, 4> x, y;
    };
    Place place(std::size_t i) const;

  private:
    /// Calls body(begin, end) for the rows of cells, in pieces of which no two at work at the same
    /// time touch the same control points.
    template <typename Body>
    void forRowsApart(const Body& body) const;

    const SortedPoints& mPoints;
    NetShape mShape;
    std::size_t mRow;                    // control points along y
    std::vector<std::size_t> mRowStart;  // the first point of each row of cells along x
};

}  // namespace bandvox
