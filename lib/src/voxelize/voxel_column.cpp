#include "voxelize/voxel_column.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

namespace bandvox {

namespace {

// Rows of a column as bits. A leaf node's mask has one such word for each x.
using Rows = std::uint64_t;
constexpr Rows kAllRows = ~Rows(0);

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

using BlockRows = std::array<Rows, kBlockSide>;

void addBlock(const openvdb::Coord& block, const BlockRows& rows, ColumnVoxels& column) {
    int voxels = 0;
    for (const Rows word : rows) voxels += std::popcount(word);
    if (voxels == 0) return;
    column.voxels += voxels;
    if (voxels == VoxelLeaf::SIZE) {
        if (column.solid.empty() || column.solid.back().end != block.x()) {
            column.solid.push_back({block.x(), block.x()});
        }
        ++column.solid.back().end;
        return;
    }
    auto leaf = std::make_unique<VoxelLeaf>(block << kBlockLog2, 0.0F, false);
    float* values = leaf->buffer().data();
    VoxelLeaf::NodeMaskType active;
    for (int x = 0; x < kBlockSide; ++x) {
        active.getWord<Rows>(x) = rows[x];
        for (Rows rest = rows[x]; rest != 0; rest &= rest - 1) {
            values[x * kBlockSide * kBlockSide + std::countr_zero(rest)] = 1;
        }
    }
    leaf->setValueMask(active);
    column.leaves.push_back(std::move(leaf));
}

// Adds blocks [begin, end), which no row crosses anything in.
void addUncrossed(openvdb::Coord block, int begin, int end, Rows inside, ColumnVoxels& column) {
    if (inside == 0 || begin >= end) return;
    if (inside == kAllRows) {
        column.voxels += std::int64_t(end - begin) * VoxelLeaf::SIZE;
        if (column.solid.empty() || column.solid.back().end != begin) {
            column.solid.push_back({begin, begin});
        }
        column.solid.back().end = end;
        return;
    }
    BlockRows rows;
    rows.fill(inside);
    for (block.x() = begin; block.x() < end; ++block.x()) addBlock(block, rows, column);
}

}  // namespace

ColumnVoxels fillColumn(const openvdb::Coord& place, std::vector<RowCrossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
        return std::tie(a.voxel, a.row, a.change) < std::tie(b.voxel, b.row, b.change);
    });
    ColumnVoxels column;
    RowWindings windings;
    openvdb::Coord block = place;
    auto next = crossings.begin();
    for (int done = 0; next != crossings.end(); done = block.x() + 1) {
        // Pass on to the next block that is crossed, then through it.
        block.x() = next->voxel >> kBlockLog2;
        addUncrossed(block, done, block.x(), windings.inside(), column);
        BlockRows rows;
        for (int x = 0; x < kBlockSide; ++x) {
            const int voxel = (block.x() << kBlockLog2) + x;
            for (; next != crossings.end() && next->voxel == voxel; ++next) windings.add(*next);
            rows[x] = windings.inside();
            column.isInsideOut = column.isInsideOut || windings.isInsideOut();
        }
        addBlock(block, rows, column);
    }
    column.isClosed = windings.areZero();
    return column;
}

}  // namespace bandvox
