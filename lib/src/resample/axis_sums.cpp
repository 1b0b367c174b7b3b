#include "resample/axis_sums.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"

namespace bandvox {

namespace {

// Sums `taps` rows that are `stride` apart, weighted.
BANDVOX_FOR_EACH_INSTRUCTION_SET
void sumRows(const float* rows, std::size_t stride, const float* weights, int taps, int length,
             float* sums) {
    constexpr int kLanes = 16;
    int i = 0;
    for (; i + kLanes <= length; i += kLanes) {
        Lanes<kLanes> sum{}, row;
        for (int t = 0; t < taps; ++t) {
            loadLanes<kLanes>(rows + t * stride + i, row);
            sum += weights[t] * row;
        }
        storeLanes<kLanes>(sum, sums + i);
    }
    for (; i < length; ++i) {
        float sum = 0;
        for (int t = 0; t < taps; ++t) sum += weights[t] * rows[t * stride + i];
        sums[i] = sum;
    }
}

}  // namespace

void AxisSumScratch::resize(std::size_t side, std::size_t plane, std::size_t row) {
    first.resize(side * plane);
    second.resize(side * side * row);
}

void sumAlongAxes(const NodeCube& cube, const std::array<AxisTaps, 3>& axes,
                  AxisSumScratch& scratch, std::span<float> values) {
    const auto& [x, y, z] = axes;
    const std::size_t plane = cube.plane, row = cube.row, side = x.first.size();

    // Along x, then y: sums of planes, then of rows.
    for (std::size_t i = 0; i < side; ++i) {
        sumRows(cube.nodes + x.first[i] * plane, plane, &x.weights[i * x.taps], x.taps,
                static_cast<int>(plane), &scratch.first[i * plane]);
    }
    for (std::size_t i = 0; i < side; ++i) {
        for (std::size_t j = 0; j < side; ++j) {
            sumRows(&scratch.first[i * plane + y.first[j] * row], row, &y.weights[j * y.taps],
                    y.taps, static_cast<int>(row), &scratch.second[(i * side + j) * row]);
        }
    }

    for (std::size_t i = 0; i < side * side; ++i) {
        for (std::size_t k = 0; k < side; ++k) {
            const float* from = &scratch.second[i * row + z.first[k]];
            const float* weights = &z.weights[k * z.taps];
            float sum = 0;
            for (int t = 0; t < z.taps; ++t) sum += weights[t] * from[t];
            values[i * side + k] = sum;
        }
    }
}

}  // namespace bandvox
