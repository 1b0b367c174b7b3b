#include "scatter/net_points.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <numeric>

namespace bandvox {
namespace {

constexpr std::size_t kPointsAtOnce = 4096;

std::size_t stripOf(double u) {
    return static_cast<std::size_t>(
        findCell(u * SortedPoints::kMostCells, SortedPoints::kMostCells).cell);
}

/// Control points that count in a cell.
constexpr std::size_t kControls = 16;

}  // namespace

SortedPoints sortPoints(std::span<const double> u, std::span<const double> v,
                        std::span<const double> weight) {
    const std::size_t count = u.size();
    std::vector<std::size_t> start(SortedPoints::kMostCells + 1);
    for (const double place : u) ++start[stripOf(place) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    struct Entry {
        double u, v, weight;
        std::uint32_t origin;
    };
    std::vector<Entry> entries(count);
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
        entries[next[stripOf(u[i])]++] = {u[i], v[i], weight[i], static_cast<std::uint32_t>(i)};
    }
    constexpr std::size_t kStrips = 64;
    forPieces(SortedPoints::kMostCells, kStrips, [&](std::size_t begin, std::size_t end) {
        for (std::size_t strip = begin; strip < end; ++strip) {
            std::sort(entries.begin() + static_cast<std::ptrdiff_t>(start[strip]),
                      entries.begin() + static_cast<std::ptrdiff_t>(start[strip + 1]),
                      [](const Entry& a, const Entry& b) {
                          return a.v != b.v ? a.v < b.v : a.origin < b.origin;
                      });
        }
    });
    SortedPoints sorted;
    sorted.u.resize(count);
    sorted.v.resize(count);
    sorted.weight.resize(count);
    sorted.origin.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        sorted.u[i] = entries[i].u;
        sorted.v[i] = entries[i].v;
        sorted.weight[i] = entries[i].weight;
        sorted.origin[i] = entries[i].origin;
    }
    return sorted;
}

NetPoints::NetPoints(const SortedPoints& points, const NetShape& shape)
    : mPoints(points), mShape(shape), mRow(static_cast<std::size_t>(shape.points()[1])) {
    const auto rows = static_cast<std::size_t>(shape.cells()[0]);
    mRowStart.resize(rows + 1, points.size());
    // The order is by strips, each inside one row of cells.
    std::size_t at = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        at = static_cast<std::size_t>(
            std::partition_point(
                points.u.begin() + static_cast<std::ptrdiff_t>(at), points.u.end(),
                [&](double u) { return static_cast<std::size_t>(shape.find(u, 0).cell) < row; }) -
            points.u.begin());
        mRowStart[row] = at;
    }
}

NetPoints::Place NetPoints::place(std::size_t i) const {
    const KnotPlace x = mShape.find(mPoints.u[i], 0);
    const KnotPlace y = mShape.find(mPoints.v[i], 1);
    return {static_cast<std::size_t>(x.cell) * mRow + static_cast<std::size_t>(y.cell),
            cubicWeights(x.place), cubicWeights(y.place)};
}

void NetPoints::evaluate(std::span<const double> net, std::span<double> values) const {
    forPieces(size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Place at = place(i);
            const double* from = net.data() + at.first;
            double sum = 0;
            for (std::size_t a = 0; a < 4; ++a, from += mRow) {
                sum += at.x[a] * (at.y[0] * from[0] + at.y[1] * from[1] + at.y[2] * from[2] +
                                  at.y[3] * from[3]);
            }
            values[i] = sum;
        }
    });
}

template <typename Body>
void NetPoints::forRowsApart(const Body& body) const {
    const std::size_t rows = mRowStart.size() - 1;
    // A piece also touches the three rows of control points after it.
    const std::size_t piece = std::max<std::size_t>(4, rows / 64);
    const std::size_t pieces = (rows + piece - 1) / piece;
    for (std::size_t odd = 0; odd < 2 && odd < pieces; ++odd) {
        parallelFor(static_cast<std::int64_t>((pieces - odd + 1) / 2), [&](std::int64_t i) {
            const std::size_t begin = (2 * static_cast<std::size_t>(i) + odd) * piece;
            body(begin, std::min(rows, begin + piece));
        });
    }
}

void NetPoints::spread(std::span<const double> values, std::span<double> net) const {
    forRowsApart([&](std::size_t begin, std::size_t end) {
        for (std::size_t i = mRowStart[begin]; i < mRowStart[end]; ++i) {
            const Place at = place(i);
            double* to = net.data() + at.first;
            for (std::size_t a = 0; a < 4; ++a, to += mRow) {
                const double along = values[i] * at.x[a];
                for (std::size_t b = 0; b < 4; ++b) to[b] += along * at.y[b];
            }
        }
    });
}

void NetPoints::addNormal(NetStencil& stencil) const {
    const auto columns = static_cast<std::size_t>(mShape.cells()[1]);
    forRowsApart([&](std::size_t begin, std::size_t end) {
        // What a row of cells gathers stays in the cache; it is handed on once for each cell.
        std::vector<double> gathered(columns * kControls * kControls);
        std::vector<char> isUsed(columns);
        for (std::size_t row = begin; row < end; ++row) {
            for (std::size_t i = mRowStart[row]; i < mRowStart[row + 1]; ++i) {
                const Place at = place(i);
                const std::size_t column = at.first - row * mRow;
                double* const own = gathered.data() + column * kControls * kControls;
                isUsed[column] = 1;
                std::array<double, kControls> weights;
                for (std::size_t k = 0; k < kControls; ++k) weights[k] = at.x[k / 4] * at.y[k % 4];
                for (std::size_t k = 0; k < kControls; ++k) {
                    const double factor = mPoints.weight[i] * weights[k];
                    for (std::size_t l = k & ~std::size_t(3); l < kControls; ++l) {
                        own[k * kControls + l] += factor * weights[l];
                    }
                }
            }
            for (std::size_t column = 0; column < columns; ++column) {
                if (!isUsed[column]) continue;
                isUsed[column] = 0;
                double* const own = gathered.data() + column * kControls * kControls;
                for (std::size_t k = 0; k < kControls; ++k) {
                    double* const to = stencil.entries((row + k / 4) * mRow + column + k % 4);
                    for (std::size_t l = 0; l < kControls; ++l) {
                        // Below the blocks on the diagonal stands what is above them.
                        const double entry =
                            l / 4 < k / 4 ? own[l * kControls + k] : own[k * kControls + l];
                        to[(3 + l / 4 - k / 4) * 7 + 3 + l % 4 - k % 4] += entry;
                    }
                }
                std::fill_n(own, kControls * kControls, 0.0);
            }
        }
    });
}

}  // namespace bandvox
