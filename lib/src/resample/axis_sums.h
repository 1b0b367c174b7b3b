#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace bandvox {

/// The weights of the nodes around each of a block's places along one axis.
struct AxisTaps {
    int taps = 0;                ///< nodes for a place
    std::vector<int> first;      ///< of them, relative to the cube
    std::vector<float> weights;  ///< [place][taps]
};

/// Nodes in memory: (x, y, z) lies at x · plane + y · row + z.
struct NodeCube {
    const float* nodes;
    std::size_t plane, row;
};

/// Memory that sums along axes need on the way.
struct AxisSumScratch {
    std::vector<float> first, second;

    /// For cubes of up to `plane` and `row`, and blocks of `side` places along each axis.
    void resize(std::size_t side, std::size_t plane, std::size_t row);
};

/// Sums over the nodes around all places of a block, whose axes are those of the cube, along one
/// axis after the other; `values` [x][y][z].
void sumAlongAxes(const NodeCube& cube, const std::array<AxisTaps, 3>& axes,
                  AxisSumScratch& scratch, std::span<float> values);

}  // namespace bandvox
