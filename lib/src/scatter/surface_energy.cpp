#include "scatter/surface_energy.h"

#include "scatter/cubic_basis.h"

#include <bandvox/source/quadrature.h>

#include <cmath>
#include <cstddef>

namespace bandvox {

std::vector<GramBand> gramBands(int cells, double cellSize, int derivative) {
    // Four Gauss points are exact up to degree 7, one more than a square of cubics has.
    std::array<std::array<double, 4>, 4> ofCell{};
    const double scale = std::pow(cellSize, 1 - 2 * derivative);
    for (const IntervalPoint& point : intervalRule(3)) {
        const auto weights = cubicWeights(point.position, derivative);
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) {
                ofCell[a][b] += point.weight * scale * weights[a] * weights[b];
            }
        }
    }
    std::vector<GramBand> bands(static_cast<std::size_t>(cells) + 3);
    for (std::size_t cell = 0; cell + 3 < bands.size(); ++cell) {
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) bands[cell + a][3 + b - a] += ofCell[a][b];
        }
    }
    return bands;
}

}  // namespace bandvox
