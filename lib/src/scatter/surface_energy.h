#pragma once

#include <array>
#include <vector>

namespace bandvox {

/// Integrals of products of neighbouring splines: entry d belongs to the neighbour at d - 3.
using GramBand = std::array<double, 7>;

/// ∫ B_i^(k) B_{i+d-3}^(k) over all cells, exactly, for the uniform cubic B-splines of so many
/// cells and their derivatives of order k = 0 to 3.
std::vector<GramBand> gramBands(int cells, double cellSize, int derivative);

/// How a surface is kept smooth where data leave it open: the weights of ∫ |D^m f|², m = 1, 2, 3,
/// of which each does not change if the surface is turned.
struct EnergyWeights {
    double first = 0;
    double second = 0;
    double third = 1;

    /// Of a tension α: in frequencies ω, |ω|² (|ω|² + α²)². It is a surface of least third
    /// derivatives within distances of 1/α, and farther off one of least slope.
    static EnergyWeights ofTension(double alpha) {
        const double square = alpha * alpha;
        return {square * square, 2 * square, 1};
    }
};

}  // namespace bandvox
