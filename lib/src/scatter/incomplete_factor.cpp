#include "scatter/incomplete_factor.h"

#include "scatter/net_stencil.h"

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

constexpr std::size_t kRowsOfBlock = std::size_t(1) << 14;

}  // namespace

IncompleteFactor::IncompleteFactor(const SparseRows& matrix)
    : mMatrix(matrix), mEntry(matrix.entry), mBegin(matrix.size()), mDiagonal(matrix.size()) {
    forPieces(matrix.size(), kRowsOfBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) factorRow(row, begin);
    });
}

void IncompleteFactor::factorRow(std::size_t row, std::size_t first) {
    const std::size_t start = mMatrix.start[row];
    const std::uint32_t* const neighbor = mMatrix.neighbor.data();
    std::size_t begin = start;
    while (neighbor[begin] < first) ++begin;
    mBegin[row] = static_cast<std::uint32_t>(begin - start);
    std::size_t at = begin;
    for (; neighbor[at] < row; ++at) {
        // What the two rows have in common so far is taken off.
        const std::size_t other = neighbor[at];
        std::size_t its = mMatrix.start[other] + mBegin[other];
        const std::size_t itsDiagonal = mMatrix.start[other] + mDiagonal[other];
        double value = mEntry[at];
        for (std::size_t own = begin; own < at; ++own) {
            while (its < itsDiagonal && neighbor[its] < neighbor[own]) ++its;
            if (its >= itsDiagonal) break;
            if (neighbor[its] == neighbor[own]) value -= mEntry[own] * mEntry[its];
        }
        mEntry[at] = value / mEntry[itsDiagonal];
    }
    mDiagonal[row] = static_cast<std::uint32_t>(at - start);
    const double whole = mEntry[at];
    double pivot = whole;
    for (std::size_t own = begin; own < at; ++own) pivot -= mEntry[own] * mEntry[own];
    // What is left out can make more of a row's part in the others than there is. Such a row then
    // stands for itself, which keeps the factor positive and bounded.
    constexpr double kLeastPart = 1e-9;
    if (pivot <= kLeastPart * whole) {
        std::fill(mEntry.begin() + static_cast<std::ptrdiff_t>(begin),
                  mEntry.begin() + static_cast<std::ptrdiff_t>(at), 0.0);
        pivot = whole;
    }
    mEntry[at] = std::sqrt(pivot);
}

void IncompleteFactor::solve(std::span<const double> x, std::span<double> y) const {
    const std::uint32_t* const neighbor = mMatrix.neighbor.data();
    forPieces(x.size(), kRowsOfBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const std::size_t diagonal = mMatrix.start[row] + mDiagonal[row];
            double value = x[row];
            for (std::size_t at = mMatrix.start[row] + mBegin[row]; at < diagonal; ++at) {
                value -= mEntry[at] * y[neighbor[at]];
            }
            y[row] = value / mEntry[diagonal];
        }
        for (std::size_t row = end; row-- > begin;) {
            const std::size_t diagonal = mMatrix.start[row] + mDiagonal[row];
            const double value = y[row] / mEntry[diagonal];
            y[row] = value;
            for (std::size_t at = mMatrix.start[row] + mBegin[row]; at < diagonal; ++at) {
                y[neighbor[at]] -= mEntry[at] * value;
            }
        }
    });
}

}  // namespace bandvox
