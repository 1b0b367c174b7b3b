#include "scatter/net_stencil.h"

#include "scatter/cubic_basis.h"

#include <numeric>

namespace bandvox {
namespace {

constexpr std::size_t kNumbersAtOnce = std::size_t(1) << 14;

/// How many rows of a net make a piece of work.
std::size_t rowsAtOnce(std::size_t row) {
    return std::max<std::size_t>(1, 4096 / row);
}

struct Extents {
    std::size_t x, y;

    explicit Extents(std::array<int, 2> points)
        : x(static_cast<std::size_t>(points[0])), y(static_cast<std::size_t>(points[1])) {}
};

std::array<int, 2> coarsePoints(std::array<int, 2> fine) {
    return {fine[0] > 4 ? (fine[0] - 3) / 2 + 3 : fine[0],
            fine[1] > 4 ? (fine[1] - 3) / 2 + 3 : fine[1]};
}

/// A coarse line's share in fine index m: coarse indices from `first`, with weights.
struct FineShare {
    std::size_t first;
    std::array<double, 3> weight;  // 0 beyond the coarse line
};

std::vector<FineShare> fineShares(std::size_t fine, std::size_t coarse) {
    std::vector<FineShare> shares(fine);
    for (std::size_t m = 0; m < fine; ++m) {
        FineShare& share = shares[m];
        if (fine == coarse) {
            share = {m, {1, 0, 0}};
            continue;
        }
        share.first = m / 2;
        share.weight = m % 2 == 0 ? std::array<double, 3>{kTwoScale[3], kTwoScale[1], 0}
                                  : std::array<double, 3>{kTwoScale[4], kTwoScale[2], kTwoScale[0]};
    }
    return shares;
}

/// Where the entries of coarse index I come from: fine indices from `first` on, with weights.
struct CoarseShare {
    std::ptrdiff_t first;
    std::size_t count;
    std::array<double, 5> weight;
};

CoarseShare coarseShare(std::size_t coarseIndex, std::size_t fine, std::size_t coarse) {
    const auto at = static_cast<std::ptrdiff_t>(coarseIndex);
    if (fine == coarse) return {at, 1, {1, 0, 0, 0, 0}};
    return {2 * at - 3, 5, kTwoScale};
}

/// One axis of P^T A P. `lines`: how many independent lines there are; `at(line, i, d)`: the entry
/// at i for the neighbour at d - 3.
template <typename From, typename To>
void coarsenAxis(std::size_t fine, std::size_t coarse, std::size_t line, const From& from,
                 const To& to) {
    for (std::size_t i = 0; i < coarse; ++i) {
        const CoarseShare own = coarseShare(i, fine, coarse);
        for (std::size_t d = 0; d < 7; ++d) {
            const auto other = static_cast<std::ptrdiff_t>(i + d) - 3;
            double sum = 0;
            if (other >= 0 && other < static_cast<std::ptrdiff_t>(coarse)) {
                const CoarseShare its = coarseShare(static_cast<std::size_t>(other), fine, coarse);
                for (std::size_t a = 0; a < own.count; ++a) {
                    const std::ptrdiff_t m = own.first + static_cast<std::ptrdiff_t>(a);
                    if (m < 0 || m >= static_cast<std::ptrdiff_t>(fine)) continue;
                    for (std::size_t b = 0; b < its.count; ++b) {
                        const std::ptrdiff_t gap =
                            its.first + static_cast<std::ptrdiff_t>(b) - m + 3;
                        if (gap < 0 || gap > 6) continue;
                        sum +=
                            own.weight[a] * its.weight[b] *
                            from(line, static_cast<std::size_t>(m), static_cast<std::size_t>(gap));
                    }
                }
            }
            to(line, i, d) = sum;
        }
    }
}

}  // namespace

NetStencil::NetStencil(std::array<int, 2> points) : mPoints(points) {
    const Extents extents(points);
    mEntries.resize(extents.x * extents.y * kEntries);
}

void NetStencil::addEnergy(const EnergyWeights& weights, double factor,
                           std::array<double, 2> cellSize) {
    std::array<std::vector<GramBand>, 4> x, y;
    for (std::size_t order = 0; order < 4; ++order) {
        x[order] = gramBands(mPoints[0] - 3, cellSize[0], static_cast<int>(order));
        y[order] = gramBands(mPoints[1] - 3, cellSize[1], static_cast<int>(order));
    }
    // ∫ |D^m f|² is the sum of binomial(m, k) ∫ (∂^m f / ∂x^(m-k) ∂y^k)².
    struct Term {
        std::size_t x, y;
        double weight;
    };
    const std::array<Term, 9> terms{{{3, 0, weights.third},
                                     {2, 1, 3 * weights.third},
                                     {1, 2, 3 * weights.third},
                                     {0, 3, weights.third},
                                     {2, 0, weights.second},
                                     {1, 1, 2 * weights.second},
                                     {0, 2, weights.second},
                                     {1, 0, weights.first},
                                     {0, 1, weights.first}}};
    const Extents extents(mPoints);
    forPieces(extents.x, rowsAtOnce(extents.y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t j = 0; j < extents.y; ++j) {
                double* const own = entries(i * extents.y + j);
                for (const Term& term : terms) {
                    for (std::size_t a = 0; a < 7; ++a) {
                        const double along = factor * term.weight * x[term.x][i][a];
                        for (std::size_t b = 0; b < 7; ++b) {
                            own[a * 7 + b] += along * y[term.y][j][b];
                        }
                    }
                }
            }
        }
    });
}

double NetStencil::meanDiagonal() const {
    double sum = 0;
    for (std::size_t i = 0; i < count(); ++i) sum += entries(i)[kEntries / 2];
    return sum / static_cast<double>(count());
}

double NetStencil::rowProduct(std::size_t i, std::size_t j, std::span<const double> x) const {
    const Extents extents(mPoints);
    const double* const own = entries(i * extents.y + j);
    const std::size_t a0 = i < 3 ? 3 - i : 0;
    const std::size_t a1 = std::min<std::size_t>(7, extents.x + 3 - i);
    const bool isInside = j >= 3 && j + 3 < extents.y;
    const std::size_t b0 = j < 3 ? 3 - j : 0;
    const std::size_t b1 = std::min<std::size_t>(7, extents.y + 3 - j);
    double sum = 0;
    for (std::size_t a = a0; a < a1; ++a) {
        const double* const row = own + a * 7;
        const double* const from = x.data() + (i + a - 3) * extents.y + j - 3;
        if (isInside) {
            sum += row[0] * from[0] + row[1] * from[1] + row[2] * from[2] + row[3] * from[3] +
                   row[4] * from[4] + row[5] * from[5] + row[6] * from[6];
        } else {
            for (std::size_t b = b0; b < b1; ++b) sum += row[b] * from[b];
        }
    }
    return sum;
}

void NetStencil::multiply(std::span<const double> x, std::span<double> y) const {
    const Extents extents(mPoints);
    forPieces(extents.x, rowsAtOnce(extents.y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t j = 0; j < extents.y; ++j) {
                y[i * extents.y + j] = rowProduct(i, j, x);
            }
        }
    });
}

void NetStencil::relax(std::span<const double> b, std::span<double> x, bool forward) const {
    const Extents extents(mPoints);
    const auto relaxOne = [&](std::size_t i, std::size_t j) {
        const std::size_t at = i * extents.y + j;
        x[at] += (b[at] - rowProduct(i, j, x)) / entries(at)[kEntries / 2];
    };
    // Rows four apart do not meet, so those of a colour may be swept at once.
    constexpr std::size_t kColors = 4;
    for (std::size_t step = 0; step < kColors; ++step) {
        const std::size_t color = forward ? step : kColors - 1 - step;
        if (color >= extents.x) continue;
        const std::size_t rows = (extents.x - color + kColors - 1) / kColors;
        forPieces(rows, rowsAtOnce(extents.y), [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                const std::size_t i = color + row * kColors;
                if (forward) {
                    for (std::size_t j = 0; j < extents.y; ++j) relaxOne(i, j);
                } else {
                    for (std::size_t j = extents.y; j-- > 0;) relaxOne(i, j);
                }
            }
        });
    }
}

bool NetStencil::canCoarsen() const {
    const auto isOdd = [](int points) { return points > 4 && (points - 3) % 2 != 0; };
    return (mPoints[0] > 4 || mPoints[1] > 4) && !isOdd(mPoints[0]) && !isOdd(mPoints[1]);
}

NetStencil NetStencil::coarsened() const {
    const std::array<int, 2> coarse = coarsePoints(mPoints);
    const Extents fine(mPoints);
    const Extents small(coarse);
    // First along y, row by row of the fine net, then along x.
    NetStencil half({mPoints[0], coarse[1]});
    forPieces(fine.x, rowsAtOnce(fine.y), [&](std::size_t begin, std::size_t end) {
        for (std::size_t line = begin * 7; line < end * 7; ++line) {
            coarsenAxis(
                fine.y, small.y, line,
                [&](std::size_t l, std::size_t j, std::size_t d) {
                    return entries(l / 7 * fine.y + j)[l % 7 * 7 + d];
                },
                [&](std::size_t l, std::size_t j, std::size_t d) -> double& {
                    return half.entries(l / 7 * small.y + j)[l % 7 * 7 + d];
                });
        }
    });
    NetStencil result(coarse);
    forPieces(small.y, rowsAtOnce(fine.x), [&](std::size_t begin, std::size_t end) {
        for (std::size_t line = begin * 7; line < end * 7; ++line) {
            coarsenAxis(
                fine.x, small.x, line,
                [&](std::size_t l, std::size_t i, std::size_t d) {
                    return half.entries(i * small.y + l / 7)[d * 7 + l % 7];
                },
                [&](std::size_t l, std::size_t i, std::size_t d) -> double& {
                    return result.entries(i * small.y + l / 7)[d * 7 + l % 7];
                });
        }
    });
    return result;
}

void prolongate(std::array<int, 2> coarse, std::array<int, 2> fine, std::span<const double> y,
                std::span<double> x) {
    const Extents small(coarse);
    const Extents large(fine);
    const auto alongX = fineShares(large.x, small.x);
    const auto alongY = fineShares(large.y, small.y);
    forPieces(large.x, rowsAtOnce(large.y), [&](std::size_t begin, std::size_t end) {
        std::vector<double> line(small.y + 2);
        for (std::size_t i = begin; i < end; ++i) {
            std::fill(line.begin(), line.end(), 0);
            const FineShare& share = alongX[i];
            for (std::size_t a = 0; a < 3; ++a) {
                if (share.weight[a] == 0 || share.first + a >= small.x) continue;
                const double* const from = y.data() + (share.first + a) * small.y;
                for (std::size_t j = 0; j < small.y; ++j) line[j] += share.weight[a] * from[j];
            }
            double* const to = x.data() + i * large.y;
            for (std::size_t j = 0; j < large.y; ++j) {
                const FineShare& own = alongY[j];
                to[j] = own.weight[0] * line[own.first] + own.weight[1] * line[own.first + 1] +
                        own.weight[2] * line[own.first + 2];
            }
        }
    });
}

void restrictNet(std::array<int, 2> coarse, std::array<int, 2> fine, std::span<const double> x,
                 std::span<double> y) {
    const Extents small(coarse);
    const Extents large(fine);
    forPieces(small.x, rowsAtOnce(small.y), [&](std::size_t begin, std::size_t end) {
        std::vector<double> line(large.y);
        for (std::size_t i = begin; i < end; ++i) {
            std::fill(line.begin(), line.end(), 0);
            const CoarseShare share = coarseShare(i, large.x, small.x);
            for (std::size_t a = 0; a < share.count; ++a) {
                const std::ptrdiff_t m = share.first + static_cast<std::ptrdiff_t>(a);
                if (m < 0 || m >= static_cast<std::ptrdiff_t>(large.x)) continue;
                const double* const from = x.data() + static_cast<std::size_t>(m) * large.y;
                for (std::size_t j = 0; j < large.y; ++j) line[j] += share.weight[a] * from[j];
            }
            for (std::size_t j = 0; j < small.y; ++j) {
                const CoarseShare own = coarseShare(j, large.y, small.y);
                double sum = 0;
                for (std::size_t b = 0; b < own.count; ++b) {
                    const std::ptrdiff_t m = own.first + static_cast<std::ptrdiff_t>(b);
                    if (m < 0 || m >= static_cast<std::ptrdiff_t>(large.y)) continue;
                    sum += own.weight[b] * line[static_cast<std::size_t>(m)];
                }
                y[i * small.y + j] = sum;
            }
        }
    });
}

double dotProduct(std::span<const double> a, std::span<const double> b) {
    const std::size_t pieces = (a.size() + kNumbersAtOnce - 1) / kNumbersAtOnce;
    std::vector<double> sums(pieces);
    forPieces(a.size(), kNumbersAtOnce, [&](std::size_t begin, std::size_t end) {
        sums[begin / kNumbersAtOnce] =
            std::inner_product(a.begin() + static_cast<std::ptrdiff_t>(begin),
                               a.begin() + static_cast<std::ptrdiff_t>(end),
                               b.begin() + static_cast<std::ptrdiff_t>(begin), 0.0);
    });
    // A piece that is the whole is handed over as one.
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace bandvox
