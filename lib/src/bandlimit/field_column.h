#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/tile_reduction.h"
#include "source/sample_range.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/field_source.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bandvox {

/// What is measured on the way.
struct FieldStatistics {
    double difference = 0;  ///< largest between all samples and every second one, density
    double minimum = 0;     ///< of the density
    double maximum = 0;
    std::int64_t tiles = 0;  ///< transformed
    std::int64_t samples = 0;
    double sampleSeconds = 0;
    double transformSeconds = 0;

    void add(const FieldStatistics& other);
};

/// How a field is sampled: where, and what is made of the samples.
struct FieldSampling {
    const FieldSource& source;
    const TileLayout& layout;
    int oversample;
    const TileReduction& fine;    ///< of all samples
    const TileReduction* coarse;  ///< of every second one along each axis, or null
};

/// Fills the tiles that differ only in x, each by itself. Made once per thread, used for many
/// columns.
class FieldColumn {
  public:
    explicit FieldColumn(const FieldSampling& sampling);

    /// Does the column at (y, z).
    ColumnBlocks fill(int y, int z, FieldStatistics& statistics, Progress& progress);

  private:
    void enter(const openvdb::Coord& tile);
    double world(int axis, int sample) const;
    std::optional<float> knownIn(const openvdb::Coord& first, const openvdb::Coord& last) const;
    std::optional<float> sampleTile(const openvdb::Coord& tile, FieldStatistics& statistics,
                                    const Progress& progress);
    void samplePlane(int x, FieldStatistics& statistics);
    void sampleStrip(int x, int y, FieldStatistics& statistics);
    void sampleRow(int x, int y, std::vector<float>& row, FieldStatistics& statistics) const;
    void filterTile(FieldStatistics& statistics);
    void storeTile(const openvdb::Coord& tileOrigin, BlockStore& store) const;

    const FieldSampling mSampling;
    const TileGeometry& mGeometry;
    int mStrip;  // rows of a plane that are told to be constant together
    TileSamples mFine;
    std::optional<TileSamples> mCoarse;
    FftBuffer mBuffer;
    std::vector<float> mDensity;  // [interior]³
    std::vector<float> mRows[2];
    std::vector<float> mCoarseRows[2];

    // Of the tile at hand.
    std::int64_t mFirstSample[3] = {};  // on the lattice of all samples
    SampleRange mRange[3];              // in which the field need not be 0
};

}  // namespace bandvox
