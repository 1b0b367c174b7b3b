#include "scatter/sparse_rows.h"

#include "scatter/incomplete_factor.h"
#include "scatter/net_stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {
namespace {

constexpr std::size_t kRowsInPiece = 2048;
constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

std::size_t countAbove(std::span<const double> values, double bound) {
    // What is no number counts as well.
    return static_cast<std::size_t>(std::count_if(
        values.begin(), values.end(), [&](double value) { return !(std::abs(value) <= bound); }));
}

struct StepLimits {
    double enough;    ///< what a row may lack
    std::size_t few;  ///< rows that may lack more
    int steps;
};

/// Adds to a solution, and takes what that gives off the residual. Returns the steps.
int addGradients(const SparseRows& matrix, std::span<double> solution, std::span<double> residual,
                 const StepLimits& limits, Progress& progress) {
    const std::size_t count = matrix.size();
    const IncompleteFactor factor(matrix);
    std::vector<double> better(count), image(count);
    factor.solve(residual, better);
    std::vector<double> direction = better;
    double measure = dotProduct(residual, better);
    int step = 0;
    for (; step < limits.steps && countAbove(residual, limits.enough) > limits.few; ++step) {
        progress.throwIfInterrupted();
        matrix.multiply(direction, image);
        const double curvature = dotProduct(direction, image);
        if (!(curvature > 0)) break;
        const double length = measure / curvature;
        forPieces(count, kRowsInPiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                solution[i] += length * direction[i];
                residual[i] -= length * image[i];
            }
        });
        factor.solve(residual, better);
        const double next = dotProduct(residual, better);
        const double kept = next / measure;
        forPieces(count, kRowsInPiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                direction[i] = better[i] + kept * direction[i];
            }
        });
        measure = next;
    }
    return step;
}

/// Some rows of a matrix, and which of them each row is.
struct ChosenRows {
    std::vector<std::uint32_t> rows;   // rising
    std::vector<std::uint32_t> place;  // of each row of the whole in `rows`, or kNoRow
};

/// The rows that lack more than enough, and their neighbours up to so many times removed.
ChosenRows chooseRows(const SparseRows& matrix, std::span<const double> residual, double enough,
                      int removed) {
    ChosenRows chosen;
    chosen.place.assign(matrix.size(), kNoRow);
    const auto take = [&](std::size_t row) {
        if (chosen.place[row] != kNoRow) return;
        chosen.place[row] = 0;
        chosen.rows.push_back(static_cast<std::uint32_t>(row));
    };
    for (std::size_t row = 0; row < matrix.size(); ++row) {
        if (!(std::abs(residual[row]) <= enough)) take(row);
    }
    std::size_t begin = 0;
    for (int ring = 0; ring < removed; ++ring) {
        const std::size_t end = chosen.rows.size();
        for (; begin < end; ++begin) {
            const std::size_t row = chosen.rows[begin];
            for (std::size_t at = matrix.start[row]; at < matrix.start[row + 1]; ++at) {
                take(matrix.neighbor[at]);
            }
        }
    }
    std::sort(chosen.rows.begin(), chosen.rows.end());
    for (std::size_t i = 0; i < chosen.rows.size(); ++i) {
        chosen.place[chosen.rows[i]] = static_cast<std::uint32_t>(i);
    }
    return chosen;
}

SparseRows partOf(const SparseRows& matrix, const ChosenRows& chosen) {
    SparseRows part;
    part.start.reserve(chosen.rows.size() + 1);
    for (const std::size_t row : chosen.rows) {
        for (std::size_t at = matrix.start[row]; at < matrix.start[row + 1]; ++at) {
            const std::uint32_t place = chosen.place[matrix.neighbor[at]];
            if (place == kNoRow) continue;
            part.neighbor.push_back(place);
            part.entry.push_back(matrix.entry[at]);
        }
        part.start.push_back(part.neighbor.size());
    }
    return part;
}

/// Solves the rows that lack something as if the others were not there.
void solveAround(const SparseRows& matrix, std::span<double> solution, std::span<double> residual,
                 const ChosenRows& chosen, const StepLimits& limits, Progress& progress) {
    const SparseRows part = partOf(matrix, chosen);
    std::vector<double> added(part.size()), lacking(part.size());
    for (std::size_t i = 0; i < part.size(); ++i) lacking[i] = residual[chosen.rows[i]];
    addGradients(part, added, lacking, limits, progress);
    for (std::size_t i = 0; i < part.size(); ++i) {
        const std::size_t row = chosen.rows[i];
        solution[row] += added[i];
        residual[row] = lacking[i];
        for (std::size_t at = matrix.start[row]; at < matrix.start[row + 1]; ++at) {
            const std::size_t other = matrix.neighbor[at];
            if (chosen.place[other] == kNoRow) residual[other] -= matrix.entry[at] * added[i];
        }
    }
}

}  // namespace

void SparseRows::multiply(std::span<const double> x, std::span<double> y) const {
    forPieces(x.size(), kRowsInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double sum = 0;
            for (std::size_t k = start[i]; k < start[i + 1]; ++k) sum += entry[k] * x[neighbor[k]];
            y[i] = sum;
        }
    });
}

std::vector<double> solveSparseRows(const SparseRows& matrix, std::span<const double> right,
                                    double enough, int steps, Progress& progress) {
    constexpr std::size_t kFewOf = 200;
    constexpr int kRounds = 8;
    std::vector<double> solution(right.size()), residual(right.begin(), right.end());
    const std::size_t few = right.size() / kFewOf;
    steps -= addGradients(matrix, solution, residual, {enough, few, steps}, progress);
    for (int round = 0; round < kRounds && few > 0; ++round) {
        const std::size_t lacking = countAbove(residual, enough);
        if (lacking == 0) return solution;
        if (lacking > few) break;
        // What the surroundings get beyond their border has to be less than what was lacking.
        const ChosenRows chosen = chooseRows(matrix, residual, enough / 2, 2 + round);
        solveAround(matrix, solution, residual, chosen, {enough / 10, 0, steps}, progress);
    }
    addGradients(matrix, solution, residual, {enough, 0, steps}, progress);
    return solution;
}

}  // namespace bandvox
