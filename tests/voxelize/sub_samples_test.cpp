#include "voxelize/sub_samples.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace bandvox {
namespace {

bool isInside(const BitColumn& column, int x, int row) {
    for (const SolidRun& run : column.solid) {
        if (run.begin <= x >> kBlockLog2 && x >> kBlockLog2 < run.end) return true;
    }
    for (const BitBlock& block : column.blocks) {
        if (block.x == x >> kBlockLog2) return block.rows[x & 7] >> row & 1;
    }
    return false;
}

// Blocks that are empty, solid or neither, from x = -6 to 9.
BitColumn randomColumn(std::mt19937& random) {
    BitColumn column;
    for (int x = -6; x <= 9; ++x) {
        BlockRows rows{};
        const unsigned kind = random() % 4;
        for (Rows& word : rows) {
            if (kind == 1) word = kAllRows;
            if (kind == 2) word = Rows(random()) << 32 | random();
            if (kind == 3) word = random() % 3 == 0 ? kAllRows : 0;
        }
        column.add(x, rows);
    }
    return column;
}

TEST(SubSamples, AreCountedAsOneByOne) {
    std::mt19937 random(11);
    for (int round = 0; round < 40; ++round) {
        SubSampleColumns columns;
        for (BitColumn& column : columns) {
            column = round % 8 == 0 ? columns[0] : randomColumn(random);
            if (round % 8 == 0 && column.solid.empty()) column.addUncrossed(-5, 8, kAllRows);
        }
        std::map<int, BlockCounts> found;
        int last = -100;
        countSubSamples(
            columns,
            [&](const SolidRun& run) {
                EXPECT_GT(run.begin, last);
                for (int x = run.begin; x < run.end; ++x) found[x].fill(8);
                last = run.end - 1;
            },
            [&](int x, const BlockCounts& counts) {
                EXPECT_GT(x, last);
                found[x] = counts;
                last = x;
            });
        for (int x = -4 * kBlockSide; x < 6 * kBlockSide; ++x) {
            for (int row = 0; row < 64; ++row) {
                // The sub-samples of voxel (x, y, z) in the four columns.
                const int y = 2 * (row >> 3), z = 2 * (row & 7);
                const BitColumn& column = columns[2 * (y >> 3) + (z >> 3)];
                int expected = 0;
                for (int i = 0; i < 8; ++i) {
                    const int fineRow = 8 * ((y & 7) + (i >> 1 & 1)) + (z & 7) + (i >> 2);
                    expected += isInside(column, 2 * x + (i & 1), fineRow);
                }
                const auto block = found.find(x >> kBlockLog2);
                const int count = block == found.end() ? 0 : block->second[64 * (x & 7) + row];
                ASSERT_EQ(count, expected) << x << " " << row;
            }
        }
    }
}

}  // namespace
}  // namespace bandvox
