#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace bandvox {

using DensityLeaf = openvdb::FloatTree::LeafNodeType;

/// What a leaf node takes of memory, with the administration of the two pieces that it consists of.
constexpr std::size_t kBytesOfLeaf = DensityLeaf::SIZE * sizeof(float) + 128;

/// A cube of 8³ voxels that all have one whole value.
struct ConstantBlock {
    openvdb::Coord origin;
    float value;
};

/// The part of a grid that one column of tiles has made.
struct ColumnBlocks {
    std::vector<std::unique_ptr<DensityLeaf>> inner;   ///< complete
    std::vector<std::unique_ptr<DensityLeaf>> border;  ///< go on in other tiles; 0 there
    std::vector<ConstantBlock> constant;               ///< complete
    /// Of each tile along x the one value of all its voxels, which no block above holds, or NaN if
    /// it has several. Empty if all are 0.
    std::vector<float> farValues;
};

/// Leaf nodes of one column of tiles while they are made.
///
/// Tiles do not respect the borders of leaf nodes, so a block may be filled in several pieces,
/// and what a column does not fill of a block is completed later (see assembleGrid).
class BlockStore {
  public:
    /// `region`: the column's voxels. `threshold`: values nearer to a whole number than this
    /// are that number.
    BlockStore(const openvdb::CoordBBox& region, double threshold);

    /// Sets the voxels of `box`, which lies in the region and in one block, to one value.
    void fill(const openvdb::CoordBBox& box, float value);

    /// Sets the voxels of `box`, which lies in the region and in one block; the value at its
    /// first voxel is values[0], steps along x and y are `xStride` and `yStride`.
    void copy(const openvdb::CoordBBox& box, const float* values, std::ptrdiff_t xStride,
              std::ptrdiff_t yStride);

    /// Sorts the blocks that end before voxel `x`. They must not be touched again. Voxels never
    /// set are 0.
    void finishBefore(int x);

    /// What was made, once all is finished.
    ColumnBlocks take() { return std::move(mBlocks); }

  private:
    DensityLeaf& leafAt(const openvdb::Coord& voxel);
    std::size_t indexOf(const openvdb::Coord& voxel) const;
    void finish(std::unique_ptr<DensityLeaf> leaf, bool isComplete);

    float mThreshold;
    openvdb::Coord mFirstBlock;  // block coordinates: voxel / 8
    openvdb::Coord mBlockCount;
    int mFinished = 0;  // slabs of blocks along x
    std::vector<std::unique_ptr<DensityLeaf>> mLeaves;
    std::vector<std::uint16_t> mFilled;  // voxels set of each block
    ColumnBlocks mBlocks;
};

/// Calls visit(box) for the part of each 8³ block that lies in `box`.
template <typename Visitor>
void forEachBlock(const openvdb::CoordBBox& box, const Visitor& visit) {
    constexpr int kMask = DensityLeaf::DIM - 1;
    const openvdb::Coord low = box.min();
    const openvdb::Coord high = box.max();
    for (int x = low.x(); x <= high.x(); x = (x | kMask) + 1) {
        for (int y = low.y(); y <= high.y(); y = (y | kMask) + 1) {
            for (int z = low.z(); z <= high.z(); z = (z | kMask) + 1) {
                visit(openvdb::CoordBBox(x, y, z, std::min(x | kMask, high.x()),
                                         std::min(y | kMask, high.y()),
                                         std::min(z | kMask, high.z())));
            }
        }
    }
}

/// The whole number that all values of a leaf are within `threshold` of, if there is one.
bool isConstant(const DensityLeaf& leaf, float threshold, float& value);

}  // namespace bandvox
