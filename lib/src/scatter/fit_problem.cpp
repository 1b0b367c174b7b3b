#include "scatter/fit_problem.h"

#include "scatter/column_scale.h"
#include "scatter/fit_limits.h"
#include "scatter/surface_energy.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace bandvox {
namespace {

constexpr int kWidestMargin = 16;

/// The energy of one control point far from the border.
double energyOfControl(const EnergyWeights& weights, std::array<double, 2> cell) {
    // ∫ of the squares of a B-spline's derivatives of order 0 to 3, for cells of side 1.
    constexpr std::array<double, 4> kSquares{151.0 / 315, 2.0 / 3, 8.0 / 3, 20};
    const auto square = [&](std::size_t axis, std::size_t order) {
        return kSquares[order] * std::pow(cell[axis], 1 - 2 * static_cast<int>(order));
    };
    const auto pair = [&](std::size_t x, std::size_t y) { return square(0, x) * square(1, y); };
    return weights.third * (pair(3, 0) + 3 * pair(2, 1) + 3 * pair(1, 2) + pair(0, 3)) +
           weights.second * (pair(2, 0) + 2 * pair(1, 1) + pair(0, 2)) +
           weights.first * (pair(1, 0) + pair(0, 1));
}

}  // namespace

void checkFitOptions(const FitSurfaceOptions& options) {
    constexpr int kFinest = 13;
    checkFitLimits(
        {"a fit", options.tolerance, options.noise, options.maxLevel, kFinest, options.tension});
}

void checkInside(const ScatteredPoints& points, const Rectangle& r) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double x = points.x[i];
        const double y = points.y[i];
        if (x >= r.x0 && x <= r.x1 && y >= r.y0 && y <= r.y1) continue;
        std::string message = "the place (" + std::to_string(x) + ", ";
        message +=
            std::to_string(y) + ")" + lineOfPoint(points, i) + " is outside the rectangle from (";
        message += std::to_string(r.x0) + ", " + std::to_string(r.y0) + ") to (";
        message += std::to_string(r.x1) + ", " + std::to_string(r.y1) + "); expected all inside";
        throw Error(ErrorKind::Input, message);
    }
}

UnitPoints makeUnitPoints(const MergedPoints& merged, const Rectangle& rectangle) {
    const ScatteredPoints& points = merged.points;
    UnitPoints unit;
    unit.rectangle = rectangle;
    const double root = std::sqrt(rectangle.width()) * std::sqrt(rectangle.height());
    unit.side = {rectangle.width() / root, rectangle.height() / root};
    std::vector<double> u(points.size()), v(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        u[i] = std::clamp((points.x[i] - rectangle.x0) / rectangle.width(), 0.0, 1.0);
        v[i] = std::clamp((points.y[i] - rectangle.y0) / rectangle.height(), 0.0, 1.0);
    }
    unit.points = sortPoints(u, v, merged.weight);
    for (int column = 0; column < points.columns; ++column) {
        const ColumnScale scale = scaleOfColumn(points, column);
        auto& values = unit.values.emplace_back(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            values[i] = (points.value(unit.points.origin[i], column) - scale.mean) / scale.range;
        }
        unit.mean.push_back(scale.mean);
        unit.range.push_back(scale.range);
    }
    return unit;
}

NetShape shapeOfLevel(int level, std::array<double, 2> side, bool withMargin) {
    const int flatter = static_cast<int>(std::lround(std::abs(std::log2(side[0] / side[1]))));
    const int longer = 1 << level;
    const int shorter = level > flatter ? 1 << (level - flatter) : 1;
    NetShape shape;
    shape.inner = side[0] >= side[1] ? std::array{longer, shorter} : std::array{shorter, longer};
    if (!withMargin) return shape;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        shape.margin[axis] = std::clamp(shape.inner[axis] / 2, 1, kWidestMargin);
    }
    return shape;
}

NetStencil makeNormalStencil(const NetPoints& points, std::array<double, 2> side, double tension,
                             double stiffness) {
    const NetShape& shape = points.shape();
    const std::array<double, 2> cell{side[0] / shape.inner[0], side[1] / shape.inner[1]};
    const EnergyWeights weights = EnergyWeights::ofTension(tension);
    // The mean sum of squares of the 16 splines at a point.
    constexpr double kWeightOfPoint = 151.0 / 315 * 151.0 / 315;
    NetStencil stencil(shape.points());
    points.addNormal(stencil);
    stencil.addEnergy(weights, stiffness * kWeightOfPoint / energyOfControl(weights, cell), cell);
    return stencil;
}

int levelOfPoints(const UnitPoints& unit) {
    // The distance from each point to the next one is looked for in the cells around it.
    const std::size_t count = unit.points.size();
    constexpr int kDeepest = 7;
    int level = 1;
    while (level < kDeepest && std::pow(4, level) < static_cast<double>(count)) ++level;
    const NetShape shape = shapeOfLevel(level, unit.side, false);
    const NetPoints places(unit.points, shape);
    const std::size_t row = static_cast<std::size_t>(shape.points()[1]);
    std::vector<std::vector<std::size_t>> cells(shape.count());
    for (std::size_t i = 0; i < count; ++i) cells[places.place(i).first].push_back(i);
    std::vector<double> nearest;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t own = places.place(i).first;
        double least = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
                const std::size_t cell = own + a * row + b;
                if (cell < row + 1 || cell - row - 1 >= cells.size()) continue;
                for (const std::size_t other : cells[cell - row - 1]) {
                    if (other == i) continue;
                    const double du = (unit.points.u[i] - unit.points.u[other]) * unit.side[0];
                    const double dv = (unit.points.v[i] - unit.points.v[other]) * unit.side[1];
                    least = std::min(least, std::hypot(du, dv));
                }
            }
        }
        nearest.push_back(least);
    }
    const auto tenth = nearest.begin() + static_cast<std::ptrdiff_t>(count / 10);
    std::nth_element(nearest.begin(), tenth, nearest.end());
    const double longest = std::max(unit.side[0], unit.side[1]);
    return std::clamp(static_cast<int>(std::ceil(std::log2(longest / *tenth))), 1, kDeepest);
}

}  // namespace bandvox
