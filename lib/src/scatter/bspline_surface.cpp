#include "scatter/cubic_basis.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/scatter/bspline_surface.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace bandvox {
namespace {

constexpr int kRowsAtOnce = 16;

std::size_t controlCount(std::array<int, 2> cells) {
    return (static_cast<std::size_t>(cells[0]) + 3) * (static_cast<std::size_t>(cells[1]) + 3);
}

void checkShape(const Rectangle& rectangle, std::array<int, 2> cells, int columns) {
    const bool isShape = rectangle.width() > 0 && rectangle.height() > 0 &&
                         std::isfinite(rectangle.width()) && std::isfinite(rectangle.height());
    if (isShape && cells[0] >= 1 && cells[1] >= 1 && columns >= 1) return;
    throw Error(ErrorKind::Usage, "a surface of " + std::to_string(cells[0]) + " x " +
                                      std::to_string(cells[1]) + " cells and " +
                                      std::to_string(columns) +
                                      " columns; expected 1 of each at least, over a rectangle "
                                      "that has a finite area");
}

/// Weights of four control points at each of `count` places from border to border.
struct SampledBasis {
    std::vector<int> cell;
    std::vector<std::array<double, 4>> weight;
};

SampledBasis sampleBasis(int count, int cells, int derivative, double cellSize) {
    SampledBasis basis;
    const double scale = std::pow(cellSize, -derivative);
    for (int i = 0; i < count; ++i) {
        const double knot = i * static_cast<double>(cells) / (count - 1);
        const auto [cell, place] = findCell(knot, cells);
        basis.cell.push_back(cell);
        basis.weight.push_back(cubicWeights(place, derivative));
        for (double& weight : basis.weight.back()) weight *= scale;
    }
    return basis;
}

/// Calls body(row) for each row, several of them in one task.
template <typename Body>
void forRows(std::int64_t rows, const Body& body) {
    parallelFor((rows + kRowsAtOnce - 1) / kRowsAtOnce, [&](std::int64_t task) {
        const std::int64_t end = std::min(rows, (task + 1) * kRowsAtOnce);
        for (std::int64_t row = task * kRowsAtOnce; row < end; ++row) body(row);
    });
}

/// Fine control point m of those with cells half as wide, from coarse ones `stride` apart.
double refineOne(const double* coarse, int m, int count, std::ptrdiff_t stride) {
    // Of the coarse control points only I with m = 2 I - 3 + a count.
    const int first = m / 2;
    double sum = 0;
    for (int coarseIndex = first; coarseIndex <= std::min(first + 2, count - 1); ++coarseIndex) {
        const int a = m + 3 - 2 * coarseIndex;
        if (a < 0 || a > 4) continue;
        sum += kTwoScale[static_cast<std::size_t>(a)] * coarse[coarseIndex * stride];
    }
    return sum;
}

}  // namespace

std::array<double, 3> SurfaceJet::normal() const {
    const double length = std::sqrt(dx * dx + dy * dy + 1);
    return {-dx / length, -dy / length, 1 / length};
}

double SurfaceJet::gaussianCurvature() const {
    const double metric = 1 + dx * dx + dy * dy;
    return (dxx * dyy - dxy * dxy) / (metric * metric);
}

double SurfaceJet::meanCurvature() const {
    const double metric = 1 + dx * dx + dy * dy;
    const double numerator = (1 + dy * dy) * dxx - 2 * dx * dy * dxy + (1 + dx * dx) * dyy;
    return numerator / (2 * metric * std::sqrt(metric));
}

BsplineSurface::BsplineSurface(const Rectangle& rectangle, std::array<int, 2> cells, int columns,
                               std::vector<double> control)
    : mRectangle(rectangle), mCells(cells), mColumns(columns), mControl(std::move(control)) {
    checkShape(rectangle, cells, columns);
    const std::size_t expected = controlCount(cells) * static_cast<std::size_t>(columns);
    if (mControl.size() == expected) return;
    throw Error(ErrorKind::Usage, "a surface has " + std::to_string(mControl.size()) +
                                      " control values; expected " + std::to_string(expected));
}

BsplineSurface::BsplineSurface(const Rectangle& rectangle, std::array<int, 2> cells, int columns)
    : mRectangle(rectangle), mCells(cells), mColumns(columns) {
    checkShape(rectangle, cells, columns);
    mControl.resize(controlCount(cells) * static_cast<std::size_t>(columns));
}

std::span<const double> BsplineSurface::control(int column) const {
    const std::size_t count = controlCount(mCells);
    return std::span(mControl).subspan(static_cast<std::size_t>(column) * count, count);
}

std::span<double> BsplineSurface::control(int column) {
    const std::size_t count = controlCount(mCells);
    return std::span(mControl).subspan(static_cast<std::size_t>(column) * count, count);
}

double BsplineSurface::value(double x, double y, int column) const {
    return jet(x, y, column).value;
}

SurfaceJet BsplineSurface::jet(double x, double y, int column) const {
    const double perX = mCells[0] / mRectangle.width();
    const double perY = mCells[1] / mRectangle.height();
    const KnotPlace alongX = findCell((x - mRectangle.x0) * perX, mCells[0]);
    const KnotPlace alongY = findCell((y - mRectangle.y0) * perY, mCells[1]);
    const std::size_t rows = static_cast<std::size_t>(mCells[1]) + 3;
    const double* const corner = control(column).data() +
                                 static_cast<std::size_t>(alongX.cell) * rows +
                                 static_cast<std::size_t>(alongY.cell);
    // along[b][d]: the derivative of order d along x, for the control points b along y.
    std::array<std::array<double, 3>, 4> along{};
    for (int d = 0; d < 3; ++d) {
        const auto weights = cubicWeights(alongX.place, d);
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) {
                along[b][static_cast<std::size_t>(d)] += weights[a] * corner[a * rows + b];
            }
        }
    }
    const auto sum = [&](std::size_t dx, int dy) {
        const auto weights = cubicWeights(alongY.place, dy);
        double total = 0;
        for (std::size_t b = 0; b < 4; ++b) total += weights[b] * along[b][dx];
        return total;
    };
    return {sum(0, 0),
            sum(1, 0) * perX,
            sum(0, 1) * perY,
            sum(2, 0) * perX * perX,
            sum(1, 1) * perX * perY,
            sum(0, 2) * perY * perY};
}

std::vector<double> BsplineSurface::sample(const GridSampling& grid,
                                           const Progress& progress) const {
    if (grid.nx < 2 || grid.ny < 2 || grid.column < 0 || grid.column >= mColumns || grid.dx < 0 ||
        grid.dx > 3 || grid.dy < 0 || grid.dy > 3) {
        throw Error(ErrorKind::Usage,
                    "a grid of " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) +
                        " samples of column " + std::to_string(grid.column) +
                        "; expected 2 x 2 at least, a column that is there, and derivatives of "
                        "order 0 to 3");
    }
    const SampledBasis x = sampleBasis(grid.nx, mCells[0], grid.dx, mRectangle.width() / mCells[0]);
    const SampledBasis y =
        sampleBasis(grid.ny, mCells[1], grid.dy, mRectangle.height() / mCells[1]);
    const std::size_t rows = static_cast<std::size_t>(mCells[1]) + 3;
    const double* const net = control(grid.column).data();
    const auto ny = static_cast<std::size_t>(grid.ny);
    std::vector<double> samples(static_cast<std::size_t>(grid.nx) * ny);
    parallelFor((grid.nx + kRowsAtOnce - 1) / kRowsAtOnce, [&](std::int64_t task) {
        progress.throwIfInterrupted();
        std::vector<double> line(rows);
        const auto end =
            static_cast<std::size_t>(std::min<std::int64_t>(grid.nx, (task + 1) * kRowsAtOnce));
        for (auto i = static_cast<std::size_t>(task * kRowsAtOnce); i < end; ++i) {
            const double* const first = net + static_cast<std::size_t>(x.cell[i]) * rows;
            const auto& a = x.weight[i];
            for (std::size_t j = 0; j < rows; ++j) {
                line[j] = a[0] * first[j] + a[1] * first[rows + j] + a[2] * first[2 * rows + j] +
                          a[3] * first[3 * rows + j];
            }
            double* const out = samples.data() + i * ny;
            for (std::size_t j = 0; j < ny; ++j) {
                const double* const from = line.data() + y.cell[j];
                const auto& b = y.weight[j];
                out[j] = b[0] * from[0] + b[1] * from[1] + b[2] * from[2] + b[3] * from[3];
            }
        }
    });
    return samples;
}

BsplineSurface BsplineSurface::refined(bool alongX, bool alongY) const {
    const std::array<int, 2> cells{alongX ? 2 * mCells[0] : mCells[0],
                                   alongY ? 2 * mCells[1] : mCells[1]};
    BsplineSurface fine(mRectangle, cells, mColumns);
    const int coarseX = mCells[0] + 3;
    const int coarseY = mCells[1] + 3;
    const auto coarseRow = static_cast<std::size_t>(coarseY);
    const std::size_t fineRow = static_cast<std::size_t>(cells[1]) + 3;
    for (int column = 0; column < mColumns; ++column) {
        const double* const from = control(column).data();
        double* const to = fine.control(column).data();
        forRows(cells[0] + 3, [&](std::int64_t i) {
            std::vector<double> line(coarseRow);
            for (std::size_t j = 0; j < coarseRow; ++j) {
                line[j] = alongX ? refineOne(from + j, static_cast<int>(i), coarseX, coarseY)
                                 : from[static_cast<std::size_t>(i) * coarseRow + j];
            }
            double* const out = to + static_cast<std::size_t>(i) * fineRow;
            for (std::size_t j = 0; j < fineRow; ++j) {
                out[j] = alongY ? refineOne(line.data(), static_cast<int>(j), coarseY, 1) : line[j];
            }
        });
    }
    return fine;
}

BsplineSurface BsplineSurface::refinedTo(std::array<int, 2> cells) const {
    BsplineSurface surface = *this;
    while (surface.cells() != cells) {
        const std::array<int, 2> now = surface.cells();
        const bool alongX = now[0] < cells[0];
        const bool alongY = now[1] < cells[1];
        if ((!alongX && !alongY) || now[0] > cells[0] || now[1] > cells[1]) {
            throw Error(ErrorKind::Usage, "a surface of " + std::to_string(mCells[0]) + " x " +
                                              std::to_string(mCells[1]) + " cells cannot have " +
                                              std::to_string(cells[0]) + " x " +
                                              std::to_string(cells[1]) +
                                              "; expected a power of two times as many");
        }
        surface = surface.refined(alongX, alongY);
    }
    return surface;
}

BsplineSurface BsplineSurface::cropped(std::array<int, 2> first, std::array<int, 2> cells) const {
    const double stepX = mRectangle.width() / mCells[0];
    const double stepY = mRectangle.height() / mCells[1];
    const Rectangle rectangle{mRectangle.x0 + first[0] * stepX, mRectangle.y0 + first[1] * stepY,
                              mRectangle.x0 + (first[0] + cells[0]) * stepX,
                              mRectangle.y0 + (first[1] + cells[1]) * stepY};
    BsplineSurface part(rectangle, cells, mColumns);
    const std::size_t rows = static_cast<std::size_t>(mCells[1]) + 3;
    const std::size_t partRows = static_cast<std::size_t>(cells[1]) + 3;
    for (int column = 0; column < mColumns; ++column) {
        const auto from = control(column);
        const auto to = part.control(column);
        for (std::size_t i = 0; i < static_cast<std::size_t>(cells[0]) + 3; ++i) {
            const std::size_t start = (i + static_cast<std::size_t>(first[0])) * rows +
                                      static_cast<std::size_t>(first[1]);
            std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(start), partRows,
                        to.begin() + static_cast<std::ptrdiff_t>(i * partRows));
        }
    }
    return part;
}

void BsplineSurface::add(const BsplineSurface& coarser) {
    const BsplineSurface other = coarser.refinedTo(mCells);
    if (other.columns() != mColumns) {
        throw Error(ErrorKind::Usage, "surfaces of " + std::to_string(mColumns) + " and " +
                                          std::to_string(other.columns()) +
                                          " columns cannot be added; expected as many in both");
    }
    for (std::size_t i = 0; i < mControl.size(); ++i) mControl[i] += other.mControl[i];
}

std::array<double, 16> BsplineSurface::bezierOrdinates(int cellX, int cellY, int column) const {
    // Of four control points along a line the ordinates of the cell between the middle ones.
    const auto ordinates = [](const std::array<double, 4>& c) {
        return std::array<double, 4>{(c[0] + 4 * c[1] + c[2]) / 6, (2 * c[1] + c[2]) / 3,
                                     (c[1] + 2 * c[2]) / 3, (c[1] + 4 * c[2] + c[3]) / 6};
    };
    const std::size_t rows = static_cast<std::size_t>(mCells[1]) + 3;
    const double* const corner = control(column).data() + static_cast<std::size_t>(cellX) * rows +
                                 static_cast<std::size_t>(cellY);
    std::array<double, 16> patch{};
    for (std::size_t b = 0; b < 4; ++b) {
        const auto along =
            ordinates({corner[b], corner[rows + b], corner[2 * rows + b], corner[3 * rows + b]});
        for (std::size_t a = 0; a < 4; ++a) patch[a * 4 + b] = along[a];
    }
    for (std::size_t a = 0; a < 4; ++a) {
        const auto along =
            ordinates({patch[a * 4], patch[a * 4 + 1], patch[a * 4 + 2], patch[a * 4 + 3]});
        std::copy(along.begin(), along.end(), patch.begin() + static_cast<std::ptrdiff_t>(a * 4));
    }
    return patch;
}

}  // namespace bandvox
