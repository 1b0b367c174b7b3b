#include "bandlimit/field_column.h"

#include "core/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {

void FieldStatistics::add(const FieldStatistics& other) {
    difference = std::max(difference, other.difference);
    minimum = std::min(minimum, other.minimum);
    maximum = std::max(maximum, other.maximum);
    tiles += other.tiles;
    samples += other.samples;
    sampleSeconds += other.sampleSeconds;
    transformSeconds += other.transformSeconds;
}

FieldColumn::FieldColumn(const FieldSampling& sampling)
    : mSampling(sampling),
      mGeometry(sampling.fine.geometry()),
      // A voxel's rows, or so many that pairs of every second one come out even.
      mStrip(sampling.oversample % 4 == 0 ? sampling.oversample : 2 * sampling.oversample),
      mFine(sampling.fine),
      mBuffer(sampling.fine.allocate()),
      mDensity(static_cast<std::size_t>(mGeometry.interior) * mGeometry.interior *
               mGeometry.interior) {
    for (std::vector<float>& row : mRows) row.resize(sampling.fine.samples());
    if (!sampling.coarse) return;
    mCoarse.emplace(*sampling.coarse);
    for (std::vector<float>& row : mCoarseRows) row.resize(sampling.coarse->samples());
}

ColumnBlocks FieldColumn::fill(int y, int z, FieldStatistics& statistics, Progress& progress) {
    const TileLayout& layout = mSampling.layout;
    const openvdb::Coord low = layout.tileOrigin({0, y, z});
    const openvdb::Coord high = layout.tileOrigin({layout.count.x(), y + 1, z + 1});
    const auto threshold = static_cast<float>(mGeometry.threshold);
    BlockStore store(openvdb::CoordBBox(low, high - openvdb::Coord(1)), mGeometry.threshold);
    std::vector<float> farValues(layout.count.x(), std::numeric_limits<float>::quiet_NaN());
    for (int x = 0; x < layout.count.x(); ++x) {
        const openvdb::Coord tile(x, y, z);
        const openvdb::Coord origin = layout.tileOrigin(tile);
        if (std::optional<float> value = sampleTile(tile, statistics, progress)) {
            if (std::abs(*value - std::round(*value)) <= threshold) value = std::round(*value);
            farValues[x] = *value;
            statistics.minimum = std::min<double>(statistics.minimum, *value);
            statistics.maximum = std::max<double>(statistics.maximum, *value);
        } else {
            storeTile(origin, store);
        }
        store.finishBefore(origin.x() + mGeometry.interior);
        progress.advance();
    }
    store.finishBefore(high.x() + DensityLeaf::DIM);
    ColumnBlocks blocks = store.take();
    blocks.farValues = std::move(farValues);
    return blocks;
}

// Finds out where the tile's samples lie.
void FieldColumn::enter(const openvdb::Coord& tile) {
    const openvdb::Coord origin = mSampling.layout.tileOrigin(tile);
    const openvdb::BBoxd box = mSampling.source.bounds();
    const double perWorld = mSampling.oversample / mSampling.layout.voxelSize;
    for (int axis = 0; axis < 3; ++axis) {
        mFirstSample[axis] =
            (static_cast<std::int64_t>(origin[axis]) - mGeometry.halo) * mSampling.oversample;
        const auto first = static_cast<double>(mFirstSample[axis]);
        mRange[axis] = samplesWithin(box.min()[axis] * perWorld - first,
                                     box.max()[axis] * perWorld - first, mSampling.fine.samples());
    }
}

// The world's coordinate of a tile's sample, the same from every tile.
double FieldColumn::world(int axis, int sample) const {
    return static_cast<double>(mFirstSample[axis] + sample) / mSampling.oversample *
           mSampling.layout.voxelSize;
}

// The value of all samples from `first` to `last`, if that is known without sampling.
std::optional<float> FieldColumn::knownIn(const openvdb::Coord& first,
                                          const openvdb::Coord& last) const {
    openvdb::Vec3d low, high;
    for (int axis = 0; axis < 3; ++axis) {
        if (first[axis] >= mRange[axis].end || last[axis] < mRange[axis].begin) return 0.0F;
        low[axis] = world(axis, first[axis]);
        high[axis] = world(axis, last[axis]);
    }
    return mSampling.source.constantIn(openvdb::BBoxd(low, high));
}

// Computes the tile's densities into mDensity, or returns the value that all of them have.
std::optional<float> FieldColumn::sampleTile(const openvdb::Coord& tile,
                                             FieldStatistics& statistics,
                                             const Progress& progress) {
    progress.throwIfInterrupted();
    enter(tile);
    const int samples = mSampling.fine.samples();
    const auto known = knownIn(openvdb::Coord(0), openvdb::Coord(samples - 1));
    if (known) return known;

    const Stopwatch sampling;
    mFine.begin();
    if (mCoarse) mCoarse->begin();
    for (int x = 0; x < samples; ++x) {
        progress.throwIfInterrupted();
        samplePlane(x, statistics);
    }
    statistics.sampleSeconds += sampling.seconds();
    if (const std::optional<float> value = mFine.constant()) return value;

    const Stopwatch transform;
    filterTile(statistics);
    statistics.transformSeconds += transform.seconds();
    ++statistics.tiles;
    return std::nullopt;
}

void FieldColumn::samplePlane(int x, FieldStatistics& statistics) {
    const int samples = mSampling.fine.samples();
    const bool isCoarse = mCoarse && x % 2 == 0;
    if (const auto known = knownIn({x, 0, 0}, {x, samples - 1, samples - 1})) {
        mFine.addConstantPlane(x, *known);
        if (isCoarse) mCoarse->addConstantPlane(x / 2, *known);
        return;
    }
    for (int y = 0; y < samples; y += mStrip) {
        const auto known = knownIn({x, y, 0}, {x, y + mStrip - 1, samples - 1});
        if (!known) {
            sampleStrip(x, y, statistics);
            continue;
        }
        for (int i = y; i < y + mStrip; ++i) {
            mFine.addConstantRow(i, *known);
            if (isCoarse && i % 2 == 0) mCoarse->addConstantRow(i / 2, *known);
        }
    }
    mFine.finishPlane(x);
    if (isCoarse) mCoarse->finishPlane(x / 2);
}

// Samples rows y to y + mStrip of a plane, in pairs.
void FieldColumn::sampleStrip(int x, int y, FieldStatistics& statistics) {
    for (int i = y; i < y + mStrip; i += 2) {
        sampleRow(x, i, mRows[0], statistics);
        sampleRow(x, i + 1, mRows[1], statistics);
        mFine.addRows(i, mRows[0].data(), mRows[1].data());
        if (!mCoarse || x % 2 != 0) continue;
        // Of two pairs of rows, the first of each are every second one.
        std::vector<float>& row = mCoarseRows[i / 2 % 2];
        for (std::size_t z = 0; z < row.size(); ++z) row[z] = mRows[0][2 * z];
        if (i / 2 % 2 == 1) {
            mCoarse->addRows(i / 2 - 1, mCoarseRows[0].data(), mCoarseRows[1].data());
        }
    }
}

void FieldColumn::sampleRow(int x, int y, std::vector<float>& row,
                            FieldStatistics& statistics) const {
    const SampleRange& z = mRange[2];
    const bool isEmpty = !mRange[0].contains(x) || !mRange[1].contains(y) || z.begin >= z.end;
    const int begin = isEmpty ? 0 : z.begin;
    const int end = isEmpty ? 0 : z.end;
    std::fill(row.begin(), row.begin() + begin, 0.0F);
    std::fill(row.begin() + end, row.end(), 0.0F);
    if (isEmpty) return;
    const double step = mSampling.layout.voxelSize / mSampling.oversample;
    mSampling.source.sampleRow(
        {world(0, x), world(1, y), world(2, begin)}, {0, 0, step},
        {row.data() + begin, static_cast<std::size_t>(end) - static_cast<std::size_t>(begin)});
    statistics.samples += end - begin;
}

// Filters all samples, and every second one to compare.
void FieldColumn::filterTile(FieldStatistics& statistics) {
    const int interior = mGeometry.interior;
    mFine.filter(mBuffer.get());
    float* density = mDensity.data();
    for (int x = 0; x < interior; ++x) {
        for (int y = 0; y < interior; ++y, density += interior) {
            std::copy_n(mSampling.fine.row(mBuffer.get(), x, y), interior, density);
        }
    }
    const auto [low, high] = std::minmax_element(mDensity.begin(), mDensity.end());
    statistics.minimum = std::min<double>(statistics.minimum, *low);
    statistics.maximum = std::max<double>(statistics.maximum, *high);
    if (!mCoarse) return;

    mCoarse->filter(mBuffer.get());
    float difference = 0;
    density = mDensity.data();
    for (int x = 0; x < interior; ++x) {
        for (int y = 0; y < interior; ++y, density += interior) {
            const float* coarse = mSampling.coarse->row(mBuffer.get(), x, y);
            for (int z = 0; z < interior; ++z) {
                difference = std::max(difference, std::abs(coarse[z] - density[z]));
            }
        }
    }
    statistics.difference = std::max<double>(statistics.difference, difference);
}

void FieldColumn::storeTile(const openvdb::Coord& tileOrigin, BlockStore& store) const {
    const auto yStride = static_cast<std::ptrdiff_t>(mGeometry.interior);
    const std::ptrdiff_t xStride = yStride * yStride;
    forEachBlock(openvdb::CoordBBox::createCube(tileOrigin, mGeometry.interior),
                 [&](const openvdb::CoordBBox& part) {
                     const openvdb::Coord at = part.min() - tileOrigin;
                     store.copy(part,
                                mDensity.data() + at.x() * xStride + at.y() * yStride + at.z(),
                                xStride, yStride);
                 });
}

}  // namespace bandvox
