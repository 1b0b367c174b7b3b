#pragma once

#include "scatter/cubic_basis.h"

#include <array>
#include <cstddef>

namespace bandvox {

/// A net of control points over the unit square and a margin around it.
struct NetShape {
    std::array<int, 2> inner{1, 1};   ///< cells along each side of the square
    std::array<int, 2> margin{0, 0};  ///< cells beyond each border

    std::array<int, 2> cells() const {
        return {inner[0] + 2 * margin[0], inner[1] + 2 * margin[1]};
    }
    /// Control points along x and y.
    std::array<int, 2> points() const {
        return {inner[0] + 2 * margin[0] + 3, inner[1] + 2 * margin[1] + 3};
    }
    std::size_t count() const {
        return static_cast<std::size_t>(points()[0]) * static_cast<std::size_t>(points()[1]);
    }
    /// Where a coordinate of the square lies along an axis. Cells are found in the square, where a
    /// product with a power of two is exact, so that finer cells lie inside of coarser ones.
    KnotPlace find(double coordinate, std::size_t axis) const {
        const KnotPlace found = findCell(coordinate * inner[axis], inner[axis]);
        return {found.cell + margin[axis], found.place};
    }
};

}  // namespace bandvox
