#include "voxelize/bit_column.h"

#include <algorithm>
#include <tuple>

namespace bandvox {

namespace {

// The winding numbers of a column's rows on the way along x.
class RowWindings {
  public:
    // The rows that are inside.
    Rows inside() const { return mInside; }
    bool isInsideOut() const { return mNegative != 0; }
    bool areZero() const {
        return std::all_of(mWinding.begin(), mWinding.end(), [](int w) { return w == 0; });
    }

    void add(const RowCrossing& crossing) {
        const int winding = mWinding[crossing.row] += crossing.change;
        const Rows row = Rows(1) << crossing.row;
        mInside = winding > 0 ? mInside | row : mInside & ~row;
        mNegative = winding < 0 ? mNegative | row : mNegative & ~row;
    }

  private:
    std::array<int, kBlockSide * kBlockSide> mWinding{};
    Rows mInside = 0, mNegative = 0;
};

}  // namespace

void BitColumn::add(int x, const BlockRows& rows) {
    Rows any = 0, all = kAllRows;
    for (const Rows word : rows) {
        any |= word;
        all &= word;
    }
    if (any == 0) return;
    if (all == kAllRows) {
        addUncrossed(x, x + 1, kAllRows);
    } else {
        blocks.push_back({x, rows});
    }
}

void BitColumn::addUncrossed(int begin, int end, Rows inside) {
    if (inside == 0 || begin >= end) return;
    if (inside == kAllRows) {
        if (solid.empty() || solid.back().end != begin) solid.push_back({begin, begin});
        solid.back().end = end;
        return;
    }
    BlockRows rows;
    rows.fill(inside);
    for (int x = begin; x < end; ++x) blocks.push_back({x, rows});
}

BitColumn fillColumn(std::vector<RowCrossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
        return std::tie(a.voxel, a.row, a.change) < std::tie(b.voxel, b.row, b.change);
    });
    BitColumn column;
    RowWindings windings;
    auto next = crossings.begin();
    for (int done = 0; next != crossings.end();) {
        // Pass on to the next block that is crossed, then through it.
        const int block = next->voxel >> kBlockLog2;
        column.addUncrossed(done, block, windings.inside());
        BlockRows rows;
        for (int x = 0; x < kBlockSide; ++x) {
            const int voxel = (block << kBlockLog2) + x;
            for (; next != crossings.end() && next->voxel == voxel; ++next) windings.add(*next);
            rows[x] = windings.inside();
            column.isInsideOut = column.isInsideOut || windings.isInsideOut();
        }
        column.add(block, rows);
        done = block + 1;
    }
    column.isClosed = windings.areZero();
    return column;
}

}  // namespace bandvox
