#pragma once

#include "core/lanes.h"

#include <bandvox/spectral/spreading_kernel.h>

#include <cmath>

// How the polynomials of a SpreadingKernel are evaluated, to be compiled into loops for whichever
// instruction set those are for.
namespace bandvox {

/// Where a place lies among the nodes under a kernel.
struct NodePlace {
    int first;  ///< node
    float z;    ///< argument of the polynomials, -1 to 1
};

[[gnu::always_inline]] inline NodePlace placeOfNodes(int width, float x) {
    const float left = x - 0.5F * static_cast<float>(width);
    const float first = std::ceil(left);
    return {static_cast<int>(first), 2 * (first - left) - 1};
}

/// Horner's rule for all nodes at once: coefficient p of node j at [p·kPaddedWidth + j], highest
/// power first.
template <int kLanes>
[[gnu::always_inline]] inline void evaluateNodes(const float* coefficients, int degree, float z,
                                                 float* values) {
    Lanes<kLanes> sum, row;
    loadLanes<kLanes>(coefficients, sum);
    for (int p = 1; p <= degree; ++p) {
        loadLanes<kLanes>(coefficients + p * SpreadingKernel::kPaddedWidth, row);
        sum = sum * z + row;
    }
    storeLanes<kLanes>(sum, values);
}

}  // namespace bandvox
