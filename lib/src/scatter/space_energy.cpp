#include "scatter/space_energy.h"

#include <cmath>

namespace bandvox {
namespace {

// A block with 3 places around it, its rows along z padded.
constexpr int kAround = 3;
constexpr int kCubeSide = SpaceNet::kSide + 2 * kAround;
constexpr int kCubeRow = 16;
constexpr std::size_t kCubeNumbers = static_cast<std::size_t>(kCubeSide) * kCubeSide * kCubeRow;

constexpr std::array<std::array<double, 4>, 4> kBinomial{
    {{1, 0, 0, 0}, {-1, 1, 0, 0}, {1, -2, 1, 0}, {-1, 3, -3, 1}}};

/// A difference of some order along each axis, and how often it is among those of its sum.
struct DifferenceKind {
    std::array<int, 3> order;
    int times;
};

constexpr std::array<DifferenceKind, 19> kKinds{{{{3, 0, 0}, 1},
                                                 {{0, 3, 0}, 1},
                                                 {{0, 0, 3}, 1},
                                                 {{2, 1, 0}, 3},
                                                 {{2, 0, 1}, 3},
                                                 {{1, 2, 0}, 3},
                                                 {{0, 2, 1}, 3},
                                                 {{1, 0, 2}, 3},
                                                 {{0, 1, 2}, 3},
                                                 {{1, 1, 1}, 6},
                                                 {{2, 0, 0}, 1},
                                                 {{0, 2, 0}, 1},
                                                 {{0, 0, 2}, 1},
                                                 {{1, 1, 0}, 2},
                                                 {{1, 0, 1}, 2},
                                                 {{0, 1, 1}, 2},
                                                 {{1, 0, 0}, 1},
                                                 {{0, 1, 0}, 1},
                                                 {{0, 0, 1}, 1}}};

double weightOf(const DifferenceKind& kind, const DifferenceWeights& weights) {
    const int order = kind.order[0] + kind.order[1] + kind.order[2];
    return kind.times * (order == 3 ? weights.third : order == 2 ? weights.second : weights.first);
}

/// A term of a difference: where it stands in the cube from the difference's own place on.
struct DifferenceTerm {
    int offset, x, y;
    unsigned z;
    double factor;
};

struct DifferenceTerms {
    std::array<DifferenceTerm, 8> terms;
    std::size_t count = 0;

    explicit DifferenceTerms(const DifferenceKind& kind) {
        const auto factorOf = [&](std::size_t axis, int i) {
            return kBinomial[static_cast<std::size_t>(kind.order[axis])]
                            [static_cast<std::size_t>(i)];
        };
        for (int x = 0; x <= kind.order[0]; ++x) {
            for (int y = 0; y <= kind.order[1]; ++y) {
                for (int z = 0; z <= kind.order[2]; ++z) {
                    terms[count++] = {(x * kCubeSide + y) * kCubeRow + z, x, y,
                                      static_cast<unsigned>(z),
                                      factorOf(0, x) * factorOf(1, y) * factorOf(2, z)};
                }
            }
        }
    }
};

/// to = -Δ from, in the part of the cube that is `margin` from its border; from 7 places each.
void negativeLaplacian(const double* from, double* to, int margin) {
    constexpr int kStepX = kCubeSide * kCubeRow;
    for (int x = margin; x < kCubeSide - margin; ++x) {
        for (int y = margin; y < kCubeSide - margin; ++y) {
            const double* const row = from + (x * kCubeSide + y) * kCubeRow;
            double* const out = to + (x * kCubeSide + y) * kCubeRow;
            for (int z = margin; z < kCubeSide - margin; ++z) {
                out[z] = 6 * row[z] - (row[z - 1] + row[z + 1]) -
                         (row[z - kCubeRow] + row[z + kCubeRow]) -
                         (row[z - kStepX] + row[z + kStepX]);
            }
        }
    }
}

/// A row along z among those of the cube.
std::size_t rowOfCube(int x, int y) {
    const int row = x * kCubeSide + y;
    return static_cast<std::size_t>(row);
}

/// The bits of the rows along z of the cube around a block.
std::array<unsigned, kCubeSide * kCubeSide> rowsAround(const SpaceNet& net, std::size_t block) {
    std::array<unsigned, kCubeSide * kCubeSide> rows{};
    const SpaceNet::Place at = net.placeOf(block);
    for (int k = 0; k < 27; ++k) {
        const std::array<int, 3> step{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
        const std::int32_t other =
            net.blockOf({at[0] + step[0] * SpaceNet::kSide, at[1] + step[1] * SpaceNet::kSide,
                         at[2] + step[2] * SpaceNet::kSide});
        if (other < 0) continue;
        const auto& from = net.rowsOf(static_cast<std::size_t>(other));
        for (int x = 0; x < kCubeSide; ++x) {
            const int a = x - kAround - step[0] * SpaceNet::kSide;
            if (a < 0 || a >= SpaceNet::kSide) continue;
            for (int y = 0; y < kCubeSide; ++y) {
                const int b = y - kAround - step[1] * SpaceNet::kSide;
                if (b < 0 || b >= SpaceNet::kSide) continue;
                const int row = a * SpaceNet::kSide + b;
                const unsigned bits = from[static_cast<std::size_t>(row)];
                const int shift = kAround + step[2] * SpaceNet::kSide;
                rows[rowOfCube(x, y)] |= shift < 0 ? bits >> static_cast<unsigned>(-shift)
                                                   : bits << static_cast<unsigned>(shift);
            }
        }
    }
    constexpr unsigned kAll = (1U << static_cast<unsigned>(kCubeSide)) - 1;
    for (unsigned& row : rows) row &= kAll;
    return rows;
}

}  // namespace

DifferenceWeights DifferenceWeights::ofTension(double tension, double cell, double factor) {
    const double square = tension * tension;
    return {factor / (cell * cell * cell), 2 * factor * square / cell,
            factor * square * square * cell};
}

double DifferenceWeights::diagonal() const {
    double sum = 0;
    for (const DifferenceKind& kind : kKinds) {
        const DifferenceTerms all(kind);
        for (std::size_t t = 0; t < all.count; ++t) {
            sum += weightOf(kind, *this) * all.terms[t].factor * all.terms[t].factor;
        }
    }
    return sum;
}

SpaceEnergy::SpaceEnergy(const SpaceNet& net, const DifferenceWeights& weights)
    : mNet(net), mWeights(weights), mIsInside(net.blocks()) {
    parallelFor(static_cast<std::int64_t>(net.blocks()), [&](std::int64_t i) {
        const auto rows = rowsAround(net, static_cast<std::size_t>(i));
        constexpr unsigned kAll = (1U << static_cast<unsigned>(kCubeSide)) - 1;
        mIsInside[static_cast<std::size_t>(i)] = static_cast<char>(
            std::all_of(rows.begin(), rows.end(), [](unsigned row) { return row == kAll; }));
    });
}

/// `to`: of the block alone. For the diagonal `cube` is of no use.
void SpaceEnergy::addBorderBlock(std::size_t block, const double* cube, double* to,
                                 bool diagonal) const {
    const auto rows = rowsAround(mNet, block);
    std::array<double, kCubeNumbers> found;
    for (const DifferenceKind& kind : kKinds) {
        const double weight = weightOf(kind, mWeights);
        const DifferenceTerms all(kind);
        constexpr int kEnd = kAround + SpaceNet::kSide;
        // Take the differences.
        for (int x = kAround - kind.order[0]; x < kEnd; ++x) {
            for (int y = kAround - kind.order[1]; y < kEnd; ++y) {
                unsigned there = ~0U;
                std::array<double, kEnd> row{};
                const double* const from = cube + (x * kCubeSide + y) * kCubeRow;
                for (std::size_t t = 0; t < all.count; ++t) {
                    const DifferenceTerm& term = all.terms[t];
                    there &= rows[rowOfCube(x + term.x, y + term.y)] >> term.z;
                    if (diagonal) continue;
                    const double* const at = from + term.offset;
                    for (std::size_t z = 0; z < kEnd; ++z) row[z] += term.factor * at[z];
                }
                double* const into = found.data() + (x * kCubeSide + y) * kCubeRow;
                if (diagonal) row.fill(1);
                for (unsigned z = 0; z < kEnd; ++z) into[z] = (there >> z & 1U) != 0 ? row[z] : 0;
            }
        }
        // Give each control point its share of them.
        for (std::size_t t = 0; t < all.count; ++t) {
            const double factor = all.terms[t].factor;
            const double share = weight * (diagonal ? factor * factor : factor);
            for (int x = 0; x < SpaceNet::kSide; ++x) {
                for (int y = 0; y < SpaceNet::kSide; ++y) {
                    const double* const from =
                        found.data() + ((x + kAround) * kCubeSide + y + kAround) * kCubeRow +
                        kAround - all.terms[t].offset;
                    double* const out = to + (x * SpaceNet::kSide + y) * SpaceNet::kSide;
                    for (int z = 0; z < SpaceNet::kSide; ++z) out[z] += share * from[z];
                }
            }
        }
    }
}

void SpaceEnergy::addTo(std::span<const double> x, std::span<double> y) const {
    parallelFor(static_cast<std::int64_t>(mNet.blocks()), [&](std::int64_t i) {
        const auto block = static_cast<std::size_t>(i);
        const SpaceNet::Place at = mNet.placeOf(block);
        std::array<double, kCubeNumbers> cube, once, twice;
        mNet.gather(x, {at[0] - kAround, at[1] - kAround, at[2] - kAround}, kCubeSide, kCubeRow,
                    cube.data());
        double* const to = y.data() + block * SpaceNet::kBlock;
        if (!mIsInside[block]) return addBorderBlock(block, cube.data(), to, false);
        // Where all are there, the sums of squares are those of the powers of the Laplacian.
        std::array<double, kCubeNumbers>& thrice = cube;
        std::array<double, SpaceNet::kBlock> first;
        const auto inner = [&](const auto& numbers, std::size_t k) {
            const std::size_t row = rowOfCube(static_cast<int>(k / 64) + kAround,
                                              static_cast<int>(k / 8 % 8) + kAround);
            return numbers[row * kCubeRow + k % 8 + kAround];
        };
        negativeLaplacian(cube.data(), once.data(), 1);
        for (std::size_t k = 0; k < SpaceNet::kBlock; ++k) first[k] = inner(once, k);
        negativeLaplacian(once.data(), twice.data(), 2);
        negativeLaplacian(twice.data(), thrice.data(), kAround);
        for (std::size_t k = 0; k < SpaceNet::kBlock; ++k) {
            to[k] += mWeights.third * inner(thrice, k) + mWeights.second * inner(twice, k) +
                     mWeights.first * first[k];
        }
    });
    mNet.clearOutside(y);
}

void SpaceEnergy::addDiagonal(std::span<double> y) const {
    const double full = mWeights.diagonal();
    parallelFor(static_cast<std::int64_t>(mNet.blocks()), [&](std::int64_t i) {
        const auto block = static_cast<std::size_t>(i);
        double* const to = y.data() + block * SpaceNet::kBlock;
        if (!mIsInside[block]) return addBorderBlock(block, nullptr, to, true);
        for (std::size_t k = 0; k < SpaceNet::kBlock; ++k) to[k] += full;
    });
    mNet.clearOutside(y);
}

}  // namespace bandvox
