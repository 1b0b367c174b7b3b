#include "scatter/space_net.h"

#include <bit>
#include <cmath>

namespace bandvox {
namespace {

constexpr std::uint64_t kMiddle = std::uint64_t(1) << 20U;
constexpr unsigned kKeyBits = 21;
constexpr std::uint64_t kKeyMask = (std::uint64_t(1) << kKeyBits) - 1;

std::uint64_t keyOfBlock(const SpaceNet::Place& place) {
    const auto part = [&](std::size_t axis) {
        return static_cast<std::uint64_t>((place[axis] >> 3) + static_cast<std::int64_t>(kMiddle));
    };
    return part(0) << (2 * kKeyBits) | part(1) << kKeyBits | part(2);
}

/// The row of a place in its block, [x][y].
std::size_t rowInBlock(const SpaceNet::Place& place) {
    const int row = (place[0] & 7) * SpaceNet::kSide + (place[1] & 7);
    return static_cast<std::size_t>(row);
}

/// The cells along z that are near, as a row of bits: bit 32 is the row's own first cell.
std::uint64_t spreadBits(unsigned row, int reach) {
    std::uint64_t bits = std::uint64_t(row) << 32U;
    std::uint64_t all = bits;
    for (int i = 1; i <= reach; ++i) {
        all |= bits << static_cast<unsigned>(i) | bits >> static_cast<unsigned>(i);
    }
    return all;
}

/// From the numbers of 6 coarse control points along an axis those of 8 fine ones, by
/// `stride` apart.
void prolongRow(const double* from, std::ptrdiff_t fromStride, double* to,
                std::ptrdiff_t toStride) {
    for (int m = 0; m < 4; ++m) {
        const double a = from[m * fromStride];
        const double b = from[(m + 1) * fromStride];
        const double c = from[(m + 2) * fromStride];
        to[2 * m * toStride] = (a + b) / 2;
        to[(2 * m + 1) * toStride] = (a + c) / 8 + b * 0.75;
    }
}

/// From the numbers of 19 fine control points those of 8 coarse ones: the transpose.
void restrictRow(const double* from, std::ptrdiff_t fromStride, double* to,
                 std::ptrdiff_t toStride) {
    for (int m = 0; m < 8; ++m) {
        const double* const at = from + 2 * m * fromStride;
        to[m * toStride] = (at[0] + at[4 * fromStride]) / 8 +
                           (at[fromStride] + at[3 * fromStride]) / 2 + at[2 * fromStride] * 0.75;
    }
}

}  // namespace

void SpaceNet::addRow(const Place& row, unsigned bits) {
    const std::uint64_t key = keyOfBlock(row);
    const auto [entry, isNew] = mIndex.try_emplace(key, static_cast<std::int32_t>(mBlocks.size()));
    if (isNew) mBlocks.push_back({key, {}});
    auto& rows = mBlocks[static_cast<std::size_t>(entry->second)].rows;
    auto& there = rows[rowInBlock(row)];
    there = static_cast<std::uint8_t>(there | bits);
}

std::int32_t SpaceNet::blockOf(const Place& place) const {
    const auto entry = mIndex.find(keyOfBlock(place));
    return entry == mIndex.end() ? -1 : entry->second;
}

bool SpaceNet::contains(const Place& place) const {
    const std::int32_t block = blockOf(place);
    if (block < 0) return false;
    const unsigned row = mBlocks[static_cast<std::size_t>(block)].rows[rowInBlock(place)];
    return (row >> static_cast<unsigned>(place[2] & 7) & 1U) != 0;
}

std::size_t SpaceNet::count() const {
    std::size_t sum = 0;
    for (const Block& block : mBlocks) {
        for (const std::uint8_t row : block.rows) {
            sum += static_cast<std::size_t>(std::popcount(unsigned{row}));
        }
    }
    return sum;
}

SpaceNet::Place SpaceNet::placeOf(std::size_t block) const {
    const std::uint64_t key = mBlocks[block].key;
    const auto part = [&](unsigned shift) {
        const auto stored = static_cast<std::int64_t>(key >> shift & kKeyMask);
        return static_cast<int>(stored - static_cast<std::int64_t>(kMiddle)) * kSide;
    };
    return {part(2 * kKeyBits), part(kKeyBits), part(0)};
}

void SpaceNet::sort() {
    std::sort(mBlocks.begin(), mBlocks.end(),
              [](const Block& a, const Block& b) { return a.key < b.key; });
    for (std::size_t i = 0; i < mBlocks.size(); ++i) {
        mIndex[mBlocks[i].key] = static_cast<std::int32_t>(i);
    }
}

SpaceNet SpaceNet::controlsOfCells(const Progress& progress) const {
    SpaceNet result;
    for (std::size_t block = 0; block < mBlocks.size(); ++block) {
        progress.throwIfInterrupted();
        const Place from = placeOf(block);
        for (int i = 0; i < 64; ++i) {
            const unsigned row = mBlocks[block].rows[static_cast<std::size_t>(i)];
            if (row == 0) continue;
            const unsigned spread = row | row << 1U | row << 2U | row << 3U;
            for (int k = 0; k < 16; ++k) {
                const int x = from[0] + i / 8 + k / 4;
                const int y = from[1] + i % 8 + k % 4;
                result.addRow({x, y, from[2]}, spread & 0xFFU);
                if (spread > 0xFFU) result.addRow({x, y, from[2] + kSide}, spread >> 8U);
            }
        }
    }
    result.sort();
    return result;
}

SpaceNet SpaceNet::parents(const Progress& progress) const {
    SpaceNet result;
    // Along an axis: (i + 3) / 2, (i + 1) / 2, (i - 1) / 2 of an odd one, and (i + 2) / 2, i / 2 of
    // an even one.
    const auto first = [](int i) { return (i - (i & 1)) >> 1; };
    const auto last = [](int i) { return ((i - (i & 1)) >> 1) + 1 + (i & 1); };
    for (std::size_t block = 0; block < mBlocks.size(); ++block) {
        progress.throwIfInterrupted();
        const Place from = placeOf(block);
        for (int i = 0; i < 64; ++i) {
            const unsigned row = mBlocks[block].rows[static_cast<std::size_t>(i)];
            if (row == 0) continue;
            const int z = from[2] >> 1;  // of the first parent; a multiple of 4
            unsigned bits = 0;
            for (int k = 0; k < kSide; ++k) {
                if ((row >> static_cast<unsigned>(k) & 1U) == 0) continue;
                for (int p = first(k); p <= last(k); ++p) bits |= 1U << static_cast<unsigned>(p);
            }
            bits <<= static_cast<unsigned>(z & 7);
            const int x = from[0] + i / 8;
            const int y = from[1] + i % 8;
            for (int a = first(x); a <= last(x); ++a) {
                for (int b = first(y); b <= last(y); ++b) {
                    result.addRow({a, b, z & ~7}, bits & 0xFFU);
                    if (bits > 0xFFU) result.addRow({a, b, (z & ~7) + kSide}, bits >> 8U);
                }
            }
        }
    }
    result.sort();
    return result;
}

SpaceNet SpaceNet::dilated(double reach, bool surely, const Progress& progress) const {
    SpaceNet result;
    const auto gap = [&](int d) {
        return static_cast<double>(surely ? std::abs(d) + 1 : std::max(std::abs(d) - 1, 0));
    };
    // The half width along z for each offset along x and y.
    const int widest = static_cast<int>(std::ceil(reach)) + 1;
    struct Column {
        int dx, dy, width;
    };
    std::vector<Column> columns;
    for (int dx = -widest; dx <= widest; ++dx) {
        for (int dy = -widest; dy <= widest; ++dy) {
            int width = -1;
            while (std::hypot(gap(dx), gap(dy), gap(width + 1)) <= reach) ++width;
            if (width >= 0) columns.push_back({dx, dy, width});
        }
    }
    for (std::size_t block = 0; block < mBlocks.size(); ++block) {
        progress.throwIfInterrupted();
        const Place from = placeOf(block);
        for (int i = 0; i < 64; ++i) {
            const unsigned row = mBlocks[block].rows[static_cast<std::size_t>(i)];
            if (row == 0) continue;
            for (const Column& column : columns) {
                const int x = from[0] + i / 8 + column.dx;
                const int y = from[1] + i % 8 + column.dy;
                std::uint64_t bits = spreadBits(row, column.width);
                for (int z = from[2] - 32; bits != 0; z += kSide, bits >>= 8U) {
                    if ((bits & 0xFFU) != 0) {
                        result.addRow({x, y, z}, static_cast<unsigned>(bits & 0xFFU));
                    }
                }
            }
        }
    }
    result.sort();
    return result;
}

void SpaceNet::gather(std::span<const double> numbers, const Place& from, int side, int row,
                      double* cube) const {
    const auto part = [&](std::size_t axis, int at) {
        const int begin = std::max(at, from[axis]);
        return std::array{begin, std::min(at + kSide, from[axis] + side)};
    };
    for (int x = from[0] & ~7; x < from[0] + side; x += kSide) {
        const auto [x0, x1] = part(0, x);
        for (int y = from[1] & ~7; y < from[1] + side; y += kSide) {
            const auto [y0, y1] = part(1, y);
            for (int z = from[2] & ~7; z < from[2] + side; z += kSide) {
                const auto [z0, z1] = part(2, z);
                const std::int32_t block = blockOf({x, y, z});
                for (int a = x0; a < x1; ++a) {
                    for (int b = y0; b < y1; ++b) {
                        double* const to =
                            cube + ((a - from[0]) * side + (b - from[1])) * row + (z0 - from[2]);
                        if (block < 0) {
                            std::fill_n(to, z1 - z0, 0.0);
                            continue;
                        }
                        const std::size_t at = static_cast<std::size_t>(block) * kBlock;
                        std::copy_n(
                            numbers.data() + at + ((a - x) * kSide + (b - y)) * kSide + (z0 - z),
                            z1 - z0, to);
                    }
                }
            }
        }
    }
}

void SpaceNet::clearOutside(std::span<double> numbers) const {
    for (std::size_t block = 0; block < mBlocks.size(); ++block) {
        for (std::size_t i = 0; i < 64; ++i) {
            const unsigned row = mBlocks[block].rows[i];
            if (row == 0xFFU) continue;
            for (std::size_t k = 0; k < 8; ++k) {
                if ((row >> k & 1U) == 0) numbers[block * kBlock + i * 8 + k] = 0;
            }
        }
    }
}

void prolongSpace(const SpaceNet& coarse, const SpaceNet& fine, std::span<const double> y,
                  std::span<double> x) {
    parallelFor(static_cast<std::int64_t>(fine.blocks()), [&](std::int64_t i) {
        const auto block = static_cast<std::size_t>(i);
        const SpaceNet::Place at = fine.placeOf(block);
        std::array<double, 6 * 6 * 6> from;
        std::array<double, 8 * 6 * 6> alongX;
        std::array<double, 8 * 8 * 6> alongY;
        coarse.gather(y, {at[0] >> 1, at[1] >> 1, at[2] >> 1}, 6, 6, from.data());
        for (int k = 0; k < 36; ++k) prolongRow(from.data() + k, 36, alongX.data() + k, 36);
        for (int k = 0; k < 8 * 6; ++k) {
            const int to = k / 6 * 48 + k % 6;
            prolongRow(alongX.data() + k / 6 * 36 + k % 6, 6, alongY.data() + to, 6);
        }
        double* const end = x.data() + block * SpaceNet::kBlock;
        for (int k = 0; k < 64; ++k) prolongRow(alongY.data() + 6 * k, 1, end + 8 * k, 1);
    });
    fine.clearOutside(x);
}

void restrictSpace(const SpaceNet& coarse, const SpaceNet& fine, std::span<const double> x,
                   std::span<double> y) {
    parallelFor(static_cast<std::int64_t>(coarse.blocks()), [&](std::int64_t i) {
        const auto block = static_cast<std::size_t>(i);
        const SpaceNet::Place at = coarse.placeOf(block);
        constexpr int kFrom = 19;
        std::vector<double> from(kFrom * kFrom * kFrom);
        std::vector<double> alongX(8 * kFrom * kFrom), alongY(8 * 8 * kFrom);
        fine.gather(x, {2 * at[0] - 3, 2 * at[1] - 3, 2 * at[2] - 3}, kFrom, kFrom, from.data());
        constexpr int kSheet = kFrom * kFrom;
        for (int k = 0; k < kSheet; ++k) {
            restrictRow(from.data() + k, kSheet, alongX.data() + k, kSheet);
        }
        for (int k = 0; k < 8 * kFrom; ++k) {
            const int to = k / kFrom * 8 * kFrom + k % kFrom;
            restrictRow(alongX.data() + k / kFrom * kSheet + k % kFrom, kFrom, alongY.data() + to,
                        kFrom);
        }
        double* const end = y.data() + block * SpaceNet::kBlock;
        for (int k = 0; k < 64; ++k) restrictRow(alongY.data() + kFrom * k, 1, end + 8 * k, 1);
    });
    coarse.clearOutside(y);
}

}  // namespace bandvox
