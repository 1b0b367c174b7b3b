#include "bandlimit/color_column.h"

#include "bandlimit/block_store.h"
#include "bandlimit/element_bins.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {

using openvdb::Coord;
using openvdb::Vec3f;

namespace {

constexpr int kArea = -1;  // stands for the area where channels are named

}  // namespace

ColorColumn::ColorColumn(const ColoredMesh& mesh, const TilePlan& plan, const TileLayout& layout,
                         const TileFilter& filter, float leastArea)
    : mMesh(mesh),
      mPlan(plan),
      mLayout(layout),
      mFilter(filter),
      mLeastArea(leastArea),
      mBuffers{filter.allocate(), filter.allocate()},
      mScratch(2 * filter.bufferSize(), 0.0F),
      mArea(static_cast<std::size_t>(plan.interior) * plan.interior * plan.interior),
      mColor(mArea.size()) {}

double ColorColumn::memory(const TilePlan& plan, const TileFilter& filter) {
    return 4 * sizeof(float) * static_cast<double>(filter.bufferSize()) +
           (sizeof(float) + sizeof(Vec3f)) * std::pow(plan.interior, 3);
}

ColorBlocks ColorColumn::fill(int y, int z, std::span<const std::uint32_t> triangles,
                              const Progress& progress) {
    // Sort the triangles by tile.
    std::vector<std::vector<std::uint32_t>> lists(mLayout.count.x());
    for (const std::uint32_t triangle : triangles) {
        const openvdb::Vec3I& t = mMesh.mesh.triangles[triangle];
        const auto at = [&](int k) { return mMesh.mesh.points[t[k]].x() / mLayout.voxelSize; };
        const auto [low, high] = std::minmax({at(0), at(1), at(2)});
        const TileRange range = tilesTouching(mLayout, mPlan.halo, 0, low, high);
        for (int x = range.first; x <= range.last; ++x) lists[x].push_back(triangle);
    }

    ColorBlocks blocks;
    LeafMap leaves;
    for (int x = 0; x < mLayout.count.x(); ++x) {
        progress.throwIfInterrupted();
        const Coord tile(x, y, z);
        if (lists[x].empty() || !sampleTile(tile, lists[x], blocks)) continue;
        ++blocks.tiles;
        filterPair({kArea, 0});
        if (!keepArea()) continue;
        keepChannel(0, mBuffers[1].get());
        if (!isOneValue(1) || !isOneValue(2)) filterPair({1, 2});
        keepChannel(1, mBuffers[0].get());
        keepChannel(2, mBuffers[1].get());
        storeTile(mLayout.tileOrigin(tile), leaves);
    }
    for (auto& [origin, leaf] : leaves) blocks.leaves.push_back(std::move(leaf));
    return blocks;
}

// Collects the quadrature points that matter to the tile. Returns false if there are none.
bool ColorColumn::sampleTile(const Coord& tile, const std::vector<std::uint32_t>& triangles,
                             ColorBlocks& blocks) {
    const SamplingRegion region{mLayout.voxelSize,
                                mLayout.tileOrigin(tile).asVec3d() + mFilter.regionOffset(),
                                openvdb::Vec3d(mPlan.side)};
    mSamples.clear();
    for (const std::uint32_t triangle : triangles) {
        sampleColors(mMesh, triangle, region, mPlan.quadrature, mSamples);
    }
    if (mSamples.empty()) return false;
    blocks.samples += static_cast<std::int64_t>(mSamples.size());
    mLowest = mHighest = mSamples[0].color;
    for (const ColoredSample& sample : mSamples) {
        mLowest = openvdb::math::minComponent(mLowest, sample.color);
        mHighest = openvdb::math::maxComponent(mHighest, sample.color);
    }
    return true;
}

// Filters the samples with two of the weights that there are; what comes out lies in the buffers.
// Channels count from the middle of their values in the tile: one colour comes out as it is, and
// errors count by how much colours differ.
void ColorColumn::filterPair(const std::array<int, 2>& channels) {
    const auto weigh = [&](const ColoredSample& sample, int channel) {
        if (channel == kArea) return sample.area;
        return sample.area * (sample.color[channel] - middleOf(channel));
    };
    mPairs.clear();
    for (const ColoredSample& sample : mSamples) {
        mPairs.push_back(
            {sample.position, {weigh(sample, channels[0]), weigh(sample, channels[1])}});
    }
    for (const FftBuffer& buffer : mBuffers) {
        std::fill_n(buffer.get(), mFilter.bufferSize(), 0.0F);
    }
    mFilter.spread(mPairs, mScratch.data(), {mBuffers[0].get(), mBuffers[1].get()});
    for (int i = 0; i < 2; ++i) {
        if (channels[i] == kArea || !isOneValue(channels[i])) mFilter.apply(mBuffers[i].get());
    }
}

// Keeps the denominator. Returns false if it is too small for a colour everywhere.
bool ColorColumn::keepArea() {
    const int interior = mPlan.interior;
    float* to = mArea.data();
    for (int x = 0; x < interior; ++x) {
        for (int y = 0; y < interior; ++y) {
            to = std::copy_n(mFilter.row(mBuffers[0].get(), x, y), interior, to);
        }
    }
    return std::any_of(mArea.begin(), mArea.end(), [&](float area) { return area > mLeastArea; });
}

// Computes one channel's quotients. A mean of colours lies between them, whatever rounding does.
void ColorColumn::keepChannel(int channel, const float* buffer) {
    const float low = mLowest[channel];
    const float high = mHighest[channel];
    if (isOneValue(channel)) {
        for (Vec3f& color : mColor) color[channel] = low;
        return;
    }
    const int interior = mPlan.interior;
    std::size_t i = 0;
    for (int x = 0; x < interior; ++x) {
        for (int y = 0; y < interior; ++y) {
            const float* row = mFilter.row(buffer, x, y);
            for (int z = 0; z < interior; ++z, ++i) {
                if (!(mArea[i] > mLeastArea)) continue;
                mColor[i][channel] = std::clamp(middleOf(channel) + row[z] / mArea[i], low, high);
            }
        }
    }
}

void ColorColumn::storeTile(const Coord& tileOrigin, LeafMap& leaves) const {
    const int interior = mPlan.interior;
    const auto storePart = [&](const openvdb::CoordBBox& part) {
        ColorLeaf* leaf = nullptr;
        for (auto voxel = part.begin(); voxel; ++voxel) {
            const Coord at = *voxel - tileOrigin;
            const std::size_t i =
                (static_cast<std::size_t>(at.x()) * interior + at.y()) * interior + at.z();
            if (!(mArea[i] > mLeastArea)) continue;
            if (leaf == nullptr) {
                auto& place = leaves[part.min() & ~(ColorLeaf::DIM - 1)];
                if (!place) place = std::make_unique<ColorLeaf>(*voxel, Vec3f(0));
                leaf = place.get();
            }
            leaf->setValueOn(*voxel, mColor[i]);
        }
    };
    forEachBlock(openvdb::CoordBBox::createCube(tileOrigin, interior), storePart);
}

}  // namespace bandvox
