#include "voxelize/sub_samples.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace bandvox {

namespace {

constexpr int kNever = std::numeric_limits<int>::max();

// Reads a column on the way along x.
class BitCursor {
  public:
    explicit BitCursor(const BitColumn& column) : mColumn(column) {}

    // Leaves behind what ends before block x.
    void advanceTo(int x) {
        while (mBlock < mColumn.blocks.size() && mColumn.blocks[mBlock].x < x) ++mBlock;
        while (mRun < mColumn.solid.size() && mColumn.solid[mRun].end <= x) ++mRun;
    }

    // The first block at x or behind it that is not empty.
    int next(int x) const {
        int result = kNever;
        if (mBlock < mColumn.blocks.size()) result = mColumn.blocks[mBlock].x;
        if (mRun < mColumn.solid.size()) {
            result = std::min(result, std::max(x, mColumn.solid[mRun].begin));
        }
        return result;
    }

    // Where the solid blocks from x on end; x itself if it is not solid.
    int solidEnd(int x) const {
        const bool isSolid = mRun < mColumn.solid.size() && mColumn.solid[mRun].begin <= x;
        return isSolid ? mColumn.solid[mRun].end : x;
    }

    // The rows of the blocks x and x + 1.
    std::array<Rows, 2 * kBlockSide> rowsAt(int x) {
        std::array<Rows, 2 * kBlockSide> rows{};
        for (int half = 0; half < 2; ++half) {
            advanceTo(x + half);
            auto* const begin = rows.begin() + half * kBlockSide;
            if (solidEnd(x + half) > x + half) {
                std::fill_n(begin, kBlockSide, kAllRows);
            } else if (mBlock < mColumn.blocks.size() && mColumn.blocks[mBlock].x == x + half) {
                std::copy_n(mColumn.blocks[mBlock].rows.begin(), kBlockSide, begin);
            }
        }
        return rows;
    }

  private:
    const BitColumn& mColumn;
    std::size_t mBlock = 0, mRun = 0;
};

// Writes the counts of 4 × 4 voxels, whose sub-samples are the rows `near` and `far` along x, to
// an 8 × 8 slice of a block, from place `to` on. Many sums in one word: first of pairs along z in
// fields of 2 bits, then of both slices and of pairs along y in fields of 4.
void countSlice(Rows near, Rows far, std::uint8_t* to) {
    constexpr Rows kPairs = 0x5555555555555555, kQuads = 0x3333333333333333;
    const auto pairs = [](Rows rows) { return (rows & kPairs) + ((rows >> 1) & kPairs); };
    const Rows a = pairs(near), b = pairs(far);
    Rows even = (a & kQuads) + (b & kQuads);
    Rows odd = ((a >> 2) & kQuads) + ((b >> 2) & kQuads);
    even += even >> kBlockSide;
    odd += odd >> kBlockSide;
    for (int y = 0; y < 4; ++y, to += kBlockSide) {
        const int shift = 2 * kBlockSide * y;
        to[0] = (even >> shift) & 15;
        to[1] = (odd >> shift) & 15;
        to[2] = (even >> (shift + 4)) & 15;
        to[3] = (odd >> (shift + 4)) & 15;
    }
}

}  // namespace

void countSubSamples(const SubSampleColumns& columns,
                     const std::function<void(const SolidRun&)>& solid,
                     const std::function<void(int x, const BlockCounts&)>& block) {
    std::vector<BitCursor> cursors(columns.begin(), columns.end());
    int x = std::numeric_limits<int>::min();
    BlockCounts counts;
    while (true) {
        // Find the next block of voxels of which something is inside.
        int next = kNever, solidEnd = kNever;
        for (BitCursor& cursor : cursors) {
            cursor.advanceTo(x);
            next = std::min(next, cursor.next(x));
        }
        if (next == kNever) return;
        x = next & ~1;
        // Most of a large solid is whole runs.
        for (const BitCursor& cursor : cursors) solidEnd = std::min(solidEnd, cursor.solidEnd(x));
        if (solidEnd >= x + 2) {
            solid({x >> 1, solidEnd >> 1});
            x = solidEnd & ~1;
            continue;
        }
        for (std::size_t c = 0; c < cursors.size(); ++c) {
            const auto rows = cursors[c].rowsAt(x);
            const std::size_t corner = 4 * kBlockSide * (c >> 1) + 4 * (c & 1);
            for (std::size_t i = 0; i < kBlockSide; ++i) {
                countSlice(rows[2 * i], rows[2 * i + 1],
                           counts.data() + i * kBlockSide * kBlockSide + corner);
            }
        }
        block(x >> 1, counts);
        x += 2;
    }
}

}  // namespace bandvox
