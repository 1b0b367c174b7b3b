#include "scatter/mend_residual.h"

#include <bandvox/core/memory.h>

#include <algorithm>
#include <numeric>

namespace bandvox {
namespace {

constexpr std::size_t kPointsInPiece = 2048;

struct CellOfPoint {
    int x, y;
};

CellOfPoint cellOf(const SortedPoints& points, const NetShape& shape, std::size_t i) {
    return {shape.find(points.u[i], 0).cell, shape.find(points.v[i], 1).cell};
}

/// The points of each row of cells, by their column.
class CellRows {
  public:
    CellRows(const SortedPoints& points, const NetShape& shape)
        : mStart(static_cast<std::size_t>(shape.cells()[0]) + 1), mEntries(points.size()) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            ++mStart[static_cast<std::size_t>(cellOf(points, shape, i).x) + 1];
        }
        std::partial_sum(mStart.begin(), mStart.end(), mStart.begin());
        std::vector<std::size_t> next(mStart.begin(), mStart.end() - 1);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const CellOfPoint cell = cellOf(points, shape, i);
            mEntries[next[static_cast<std::size_t>(cell.x)]++] = {cell.y,
                                                                  static_cast<std::uint32_t>(i)};
        }
        constexpr std::size_t kRowsInPiece = 16;
        forPieces(mStart.size() - 1, kRowsInPiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                std::sort(mEntries.begin() + static_cast<std::ptrdiff_t>(mStart[row]),
                          mEntries.begin() + static_cast<std::ptrdiff_t>(mStart[row + 1]));
            }
        });
    }

    /// Calls visit(point) for the points up to three cells away, those of the cell itself too.
    template <typename Visit>
    void forNeighbors(CellOfPoint cell, const Visit& visit) const {
        const int last = static_cast<int>(mStart.size()) - 2;
        for (int row = std::max(0, cell.x - 3); row <= std::min(last, cell.x + 3); ++row) {
            const auto end = mEntries.begin() +
                             static_cast<std::ptrdiff_t>(mStart[static_cast<std::size_t>(row) + 1]);
            auto at = std::lower_bound(
                mEntries.begin() +
                    static_cast<std::ptrdiff_t>(mStart[static_cast<std::size_t>(row)]),
                end, Entry{cell.y - 3, 0});
            for (; at != end && at->column <= cell.y + 3; ++at) visit(at->point);
        }
    }

  private:
    struct Entry {
        int column;
        std::uint32_t point;
        bool operator<(const Entry& other) const {
            return column != other.column ? column < other.column : point < other.point;
        }
    };
    std::vector<std::size_t> mStart;
    std::vector<Entry> mEntries;
};

/// The sum of products of weights of two points whose cells are `gap` apart.
double overlap(const std::array<double, 4>& a, const std::array<double, 4>& b, int gap) {
    double sum = 0;
    for (int k = std::max(0, gap); k < std::min(4, 4 + gap); ++k) {
        sum += a[static_cast<std::size_t>(k)] * b[static_cast<std::size_t>(k - gap)];
    }
    return sum;
}

std::vector<std::size_t> countProducts(const SortedPoints& points, const NetShape& shape,
                                       const CellRows& rows) {
    std::vector<std::size_t> start(points.size() + 1);
    forPieces(points.size(), kPointsInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::size_t count = 0;
            rows.forNeighbors(cellOf(points, shape, i), [&](std::size_t) { ++count; });
            start[i + 1] = count;
        }
    });
    std::partial_sum(start.begin(), start.end(), start.begin());
    return start;
}

/// Fills the rows, whose starts are known.
void multiplyNeighbors(const SortedPoints& points, const NetPoints& net, const CellRows& rows,
                       SparseRows& products) {
    const NetShape& shape = net.shape();
    // Factored they are there twice.
    constexpr double kBytesOfProduct = sizeof(std::uint32_t) + 2 * sizeof(double);
    requireMemory(kBytesOfProduct * static_cast<double>(products.start.back()),
                  "a level of the fit");
    products.neighbor.resize(products.start.back());
    products.entry.resize(products.start.back());
    forPieces(points.size(), kPointsInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const CellOfPoint cell = cellOf(points, shape, i);
            const NetPoints::Place own = net.place(i);
            std::size_t at = products.start[i];
            std::uint32_t* const first = products.neighbor.data() + at;
            rows.forNeighbors(cell, [&](std::size_t other) {
                products.neighbor[at++] = static_cast<std::uint32_t>(other);
            });
            std::sort(first, products.neighbor.data() + at);
            for (std::size_t k = products.start[i]; k < at; ++k) {
                const std::size_t other = products.neighbor[k];
                const CellOfPoint its = cellOf(points, shape, other);
                const NetPoints::Place place = net.place(other);
                products.entry[k] = overlap(own.x, place.x, its.x - cell.x) *
                                    overlap(own.y, place.y, its.y - cell.y);
            }
        }
    });
}

}  // namespace

ResidualMender::ResidualMender(const SortedPoints& points, const NetShape& shape)
    : mNetPoints(points, shape) {
    const CellRows rows(points, shape);
    mProducts.start = countProducts(points, shape, rows);
    // A crowd takes the square of its size in memory.
    constexpr std::size_t kCrowd = 1000;
    for (std::size_t i = 0; i < points.size() && !mIsCrowded; ++i) {
        mIsCrowded = mProducts.start[i + 1] - mProducts.start[i] > kCrowd;
    }
    if (!mIsCrowded) multiplyNeighbors(points, mNetPoints, rows, mProducts);
}

}  // namespace bandvox
