#pragma once

#include "bandlimit/spread_samples.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "source/colored_samples.h"

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace bandvox {

using ColorLeaf = openvdb::Vec3STree::LeafNodeType;

/// The part of a grid of colours that one column of tiles has made.
struct ColorBlocks {
    std::vector<std::unique_ptr<ColorLeaf>> leaves;  ///< in order; those at the border go on in
                                                     ///< other columns, and are inactive there
    std::int64_t tiles = 0;
    std::int64_t samples = 0;
};

/// Fills the tiles that differ only in x with colours: h * (c δ_S) over h * δ_S, both filtered by
/// `filter`. Made once per thread, used for many columns.
class ColorColumn {
  public:
    /// `leastArea`: of h * δ_S, per voxel; colours are active above it.
    ColorColumn(const ColoredMesh& mesh, const TilePlan& plan, const TileLayout& layout,
                const TileFilter& filter, float leastArea);

    /// Bytes that each thread needs beside its samples.
    static double memory(const TilePlan& plan, const TileFilter& filter);

    /// Does the column at (y, z), with the triangles that may matter to it.
    ColorBlocks fill(int y, int z, std::span<const std::uint32_t> triangles,
                     const Progress& progress);

  private:
    using LeafMap = std::map<openvdb::Coord, std::unique_ptr<ColorLeaf>>;

    bool sampleTile(const openvdb::Coord& tile, const std::vector<std::uint32_t>& triangles,
                    ColorBlocks& blocks);
    void filterPair(const std::array<int, 2>& channels);
    bool keepArea();
    void keepChannel(int channel, const float* buffer);
    bool isOneValue(int channel) const { return mLowest[channel] == mHighest[channel]; }
    float middleOf(int channel) const { return 0.5F * (mLowest[channel] + mHighest[channel]); }
    void storeTile(const openvdb::Coord& tileOrigin, LeafMap& leaves) const;

    const ColoredMesh& mMesh;
    const TilePlan& mPlan;
    const TileLayout& mLayout;
    const TileFilter& mFilter;
    float mLeastArea;
    std::array<FftBuffer, 2> mBuffers;
    std::vector<float> mScratch;  // of both while samples are spread, all zero else
    std::vector<ColoredSample> mSamples;
    std::vector<PairedSample> mPairs;
    openvdb::Vec3f mLowest, mHighest;    // of the samples' colours
    std::vector<float> mArea;            // [interior]³: h * δ_S
    std::vector<openvdb::Vec3f> mColor;  // [interior]³
};

}  // namespace bandvox
