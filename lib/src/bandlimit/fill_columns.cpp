#include "bandlimit/fill_columns.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <span>
#include <utility>

namespace bandvox {

namespace {

/// Of what there is room for, bricks take so much at most, if more than those of one row.
constexpr double kShareOfBricks = 0.3;

/// What a column is taken to need before one has been seen, bytes.
constexpr double kFirstGuess = 1 << 20;

/// A vector that is filled without knowing its end.
constexpr std::size_t kGrowth = 2;

void raise(std::atomic<double>& largest, double value) {
    double before = largest.load();
    while (value > before && !largest.compare_exchange_weak(before, value)) {
    }
}

}  // namespace

ColumnStatistics FilledColumns::total() const {
    ColumnStatistics sum;
    sum.spreadSeconds = brickSeconds;
    for (const ColumnStatistics& column : statistics) sum.add(column);
    return sum;
}

std::size_t memoryOf(const ColumnBlocks& blocks) {
    const std::size_t leaves = blocks.inner.size() + blocks.border.size();
    return leaves * (kBytesOfLeaf + kGrowth * sizeof(blocks.inner[0])) +
           blocks.constant.capacity() * sizeof(ConstantBlock) +
           blocks.farValues.capacity() * sizeof(float);
}

ColumnFiller::ColumnFiller(const BoundarySource& source, const TilePlan& plan,
                           const TileLayout& layout, const TileFilter& filter,
                           std::vector<bool> wanted)
    : mSource(source),
      mPlan(plan),
      mLayout(layout),
      mFilter(filter),
      mWanted(std::move(wanted)),
      mCount(static_cast<std::int64_t>(layout.count.y()) * layout.count.z()),
      mLargestColumn(kFirstGuess),
      mPool([this] {
          return std::make_unique<DensityColumn>(mSource, mPlan, mLayout, mFilter,
                                                 mBricks ? &*mBricks : nullptr);
      }) {
    if (SpreadBricks::payFor(source, layout.voxelSize)) {
        mBricks.emplace(source, plan, layout, filter, mWanted);
    } else {
        mBins.emplace(source, layout, plan.halo);
    }
}

std::int64_t ColumnFiller::steps(const BoundarySource& source, const TilePlan& plan,
                                 const TileLayout& layout) {
    const bool hasBricks = SpreadBricks::payFor(source, layout.voxelSize);
    return static_cast<std::int64_t>(layout.count.y()) * layout.count.z() +
           (hasBricks ? SpreadBricks::steps(plan, layout) : 0);
}

double ColumnFiller::leastMemory() const {
    return mRowOfBricks + mLargestColumn;
}

// Spreads for the row of the next column, and for as many more as there is room for.
void ColumnFiller::prepareBricks(double memory, FilledColumns& columns, Progress& progress) {
    if (mNext < static_cast<std::int64_t>(mRowsEnd) * mLayout.count.z()) return;
    const double before = mBricks->spreadSeconds();
    mBricks->dropBefore(mRowsEnd);
    if (memory == kUnlimited) {
        mRowsEnd = mLayout.count.y();
        mBricks->spread({0, mRowsEnd - 1}, progress);
    } else {
        do {
            const auto held = static_cast<double>(mBricks->memory());
            mBricks->spread({mRowsEnd, mRowsEnd}, progress);
            ++mRowsEnd;
            mRowOfBricks = std::max(mRowOfBricks, static_cast<double>(mBricks->memory()) - held);
        } while (mRowsEnd < mLayout.count.y() &&
                 static_cast<double>(mBricks->memory()) + mRowOfBricks < kShareOfBricks * memory);
    }
    columns.brickSeconds = mBricks->spreadSeconds() - before;
}

FilledColumns ColumnFiller::fillNext(double memory, Progress& progress) {
    FilledColumns columns;
    std::int64_t end = mCount;
    if (mBricks) {
        prepareBricks(memory, columns, progress);
        end = static_cast<std::int64_t>(mRowsEnd) * mLayout.count.z();
        memory -= static_cast<double>(mBricks->memory());
    }
    // Each task takes one column after the other, so that what is filled has no gaps, and no more
    // of them run than there is room for columns.
    const std::int64_t begin = mNext;
    columns.blocks.resize(end - begin);
    columns.statistics.resize(end - begin);
    const std::int64_t tasks =
        static_cast<std::int64_t>(std::clamp<double>(memory / mLargestColumn, 1, threadCount()));
    std::atomic<std::int64_t> next{begin};
    std::atomic<double> held{0}, largest{mLargestColumn};
    std::atomic<bool> hasFailed{false};
    const auto isFull = [&] {
        return held + static_cast<double>(tasks) * largest > memory && next > begin;
    };
    const auto fillOne = [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const int y = static_cast<int>(i / mLayout.count.z());
        const int z = static_cast<int>(i % mLayout.count.z());
        const std::span<const std::uint32_t> elements =
            mBins ? mBins->column(y, z) : std::span<const std::uint32_t>();
        const bool hasContent = mBricks ? mBricks->isInColumn(y, z) : !elements.empty();
        if (hasContent && (mWanted.empty() || mWanted[i])) {
            std::unique_ptr<DensityColumn> worker = mPool.take();
            ColumnBlocks& blocks = columns.blocks[i - begin];
            blocks = worker->fill(y, z, elements, columns.statistics[i - begin], progress);
            mPool.giveBack(std::move(worker));
            const auto bytes = static_cast<double>(memoryOf(blocks));
            held += bytes;
            raise(largest, bytes);
        }
        progress.advance();
    };
    parallelFor(tasks, [&](std::int64_t) {
        try {
            while (!hasFailed && !isFull()) {
                const std::int64_t i = next++;
                if (i >= end) break;
                fillOne(i);
            }
        } catch (...) {
            hasFailed = true;
            throw;
        }
    });
    mNext = std::min<std::int64_t>(next, end);
    mLargestColumn = largest;
    columns.blocks.resize(mNext - begin);
    columns.statistics.resize(mNext - begin);
    return columns;
}

FilledColumns fillColumns(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter, const char* stage,
                          Progress& progress, const std::vector<bool>& wanted) {
    const ProgressStage inProgress(progress, stage, ColumnFiller::steps(source, plan, layout));
    ColumnFiller filler(source, plan, layout, filter, wanted);
    return filler.fillNext(ColumnFiller::kUnlimited, progress);
}

}  // namespace bandvox
