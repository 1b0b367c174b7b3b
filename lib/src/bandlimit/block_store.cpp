#include "bandlimit/block_store.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

constexpr int kLog2Block = DensityLeaf::LOG2DIM;
constexpr int kBlock = DensityLeaf::DIM;

openvdb::Coord blockOf(const openvdb::Coord& voxel) {
    return voxel >> kLog2Block;
}

bool isWholeBlock(const openvdb::CoordBBox& box) {
    return box.volume() == DensityLeaf::SIZE;
}

}  // namespace

bool isConstant(const DensityLeaf& leaf, float threshold, float& value) {
    const float* values = leaf.buffer().data();
    value = std::round(values[0]);
    return std::all_of(values, values + DensityLeaf::SIZE,
                       [&](float v) { return std::abs(v - value) <= threshold; });
}

BlockStore::BlockStore(const openvdb::CoordBBox& region, double threshold)
    : mThreshold(static_cast<float>(threshold)),
      mFirstBlock(blockOf(region.min())),
      mBlockCount(blockOf(region.max()) - mFirstBlock + openvdb::Coord(1)),
      mLeaves(static_cast<std::size_t>(mBlockCount.x()) * mBlockCount.y() * mBlockCount.z()),
      mFilled(mLeaves.size()) {}

std::size_t BlockStore::indexOf(const openvdb::Coord& voxel) const {
    const openvdb::Coord block = blockOf(voxel) - mFirstBlock;
    return (static_cast<std::size_t>(block.x()) * mBlockCount.y() + block.y()) * mBlockCount.z() +
           block.z();
}

DensityLeaf& BlockStore::leafAt(const openvdb::Coord& voxel) {
    std::unique_ptr<DensityLeaf>& leaf = mLeaves[indexOf(voxel)];
    if (!leaf) leaf = std::make_unique<DensityLeaf>(voxel, 0.0F);
    return *leaf;
}

void BlockStore::fill(const openvdb::CoordBBox& box, float value) {
    mFilled[indexOf(box.min())] += static_cast<std::uint16_t>(box.volume());
    if (value == 0) return;
    if (isWholeBlock(box)) {
        mBlocks.constant.push_back({box.min(), value});
        return;
    }
    float* values = leafAt(box.min()).buffer().data();
    for (auto voxel = box.begin(); voxel; ++voxel) {
        values[DensityLeaf::coordToOffset(*voxel)] = value;
    }
}

void BlockStore::copy(const openvdb::CoordBBox& box, const float* values, std::ptrdiff_t xStride,
                      std::ptrdiff_t yStride) {
    mFilled[indexOf(box.min())] += static_cast<std::uint16_t>(box.volume());
    float* to = leafAt(box.min()).buffer().data() + DensityLeaf::coordToOffset(box.min());
    const openvdb::Coord size = box.dim();
    for (int x = 0; x < size.x(); ++x) {
        for (int y = 0; y < size.y(); ++y) {
            std::copy_n(values + x * xStride + y * yStride, size.z(),
                        to + (x * kBlock + y) * kBlock);
        }
    }
}

void BlockStore::finishBefore(int x) {
    const int end = std::min((x >> kLog2Block) - mFirstBlock.x(), mBlockCount.x());
    const std::size_t slab = static_cast<std::size_t>(mBlockCount.y()) * mBlockCount.z();
    for (; mFinished < end; ++mFinished) {
        for (std::size_t i = mFinished * slab; i < (mFinished + 1) * slab; ++i) {
            if (mLeaves[i]) finish(std::move(mLeaves[i]), mFilled[i] == DensityLeaf::SIZE);
        }
    }
}

void BlockStore::finish(std::unique_ptr<DensityLeaf> leaf, bool isComplete) {
    float value = 0;
    const bool isFlat = isConstant(*leaf, mThreshold, value);
    if (isFlat && value == 0) return;  // in a border block, what the others add decides
    if (!isComplete) {
        mBlocks.border.push_back(std::move(leaf));
    } else if (isFlat) {
        mBlocks.constant.push_back({leaf->origin(), value});
    } else {
        mBlocks.inner.push_back(std::move(leaf));
    }
}

}  // namespace bandvox
