#include "bandlimit/density_column.h"

#include "core/instruction_sets.h"
#include "core/stopwatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {

namespace {

BANDVOX_FOR_EACH_INSTRUCTION_SET
void addRow(const float* differences, int count, double* sum) {
    for (int i = 0; i < count; ++i) sum[i] += differences[i];
}

struct Extent {
    float low, high;
};

// Writes the numbers in single precision, and says how far they reach.
BANDVOX_FOR_EACH_INSTRUCTION_SET
Extent roundTo(const std::vector<double>& numbers, float* rounded) {
    // What compilers turn into vectors: several extents, each of every so manyth number.
    constexpr std::size_t kLanes = 16;
    std::array<float, kLanes> low, high;
    low.fill(static_cast<float>(numbers[0]));
    high = low;
    const std::size_t whole = numbers.size() / kLanes * kLanes;
    for (std::size_t i = 0; i < whole; i += kLanes) {
        for (std::size_t l = 0; l < kLanes; ++l) {
            const auto value = static_cast<float>(numbers[i + l]);
            rounded[i + l] = value;
            low[l] = value < low[l] ? value : low[l];
            high[l] = value > high[l] ? value : high[l];
        }
    }
    Extent found{*std::min_element(low.begin(), low.end()),
                 *std::max_element(high.begin(), high.end())};
    for (std::size_t i = whole; i < numbers.size(); ++i) {
        rounded[i] = static_cast<float>(numbers[i]);
        found = {std::min(found.low, rounded[i]), std::max(found.high, rounded[i])};
    }
    return found;
}

}  // namespace

void ColumnStatistics::add(const ColumnStatistics& other) {
    closureError = std::max(closureError, other.closureError);
    minimum = std::min(minimum, other.minimum);
    maximum = std::max(maximum, other.maximum);
    highestWinding = std::max(highestWinding, other.highestWinding);
    lowestWinding = std::min(lowestWinding, other.lowestWinding);
    tiles += other.tiles;
    samples += other.samples;
    spreadSeconds += other.spreadSeconds;
    transformSeconds += other.transformSeconds;
}

DensityColumn::DensityColumn(const BoundarySource& source, const TilePlan& plan,
                             const TileLayout& layout, const TileFilter& filter,
                             const SpreadBricks* bricks)
    : mSource(source),
      mPlan(plan),
      mLayout(layout),
      mFilter(filter),
      mBricks(bricks),
      mBuffer(filter.allocate()),
      mBufferSize(filter.bufferSize()),
      mNear(plan.halo, plan.interior),
      mSum(static_cast<std::size_t>(plan.interior) * plan.interior),
      mDensity(mSum.size() * plan.interior) {}

ColumnBlocks DensityColumn::fill(int y, int z, std::span<const std::uint32_t> elements,
                                 ColumnStatistics& statistics, const Progress& progress) {
    const openvdb::Coord low = mLayout.tileOrigin({0, y, z});
    const openvdb::Coord high = mLayout.tileOrigin({mLayout.count.x(), y + 1, z + 1});
    BlockStore store(openvdb::CoordBBox(low, high - openvdb::Coord(1)), mPlan.threshold);
    const ElementLists lists = sortByTile(elements);
    std::vector<float> farValues(mLayout.count.x(), std::numeric_limits<float>::quiet_NaN());
    std::fill(mSum.begin(), mSum.end(), 0.0);
    for (int x = 0; x < mLayout.count.x(); ++x) {
        progress.throwIfInterrupted();
        const openvdb::Coord tile(x, y, z);
        const openvdb::Coord origin = mLayout.tileOrigin(tile);
        if (!fillTile(tile, lists[x], statistics)) {
            snapAll(statistics);
            farValues[x] = static_cast<float>(mSum[0]);
        } else {
            storeTile(origin, store);
        }
        store.finishBefore(origin.x() + mPlan.interior);
    }
    // Behind the object the density is 0 again.
    snapAll(statistics);
    statistics.addClosureError(std::abs(mSum[0]));
    store.finishBefore(high.x() + DensityLeaf::DIM);
    ColumnBlocks blocks = store.take();
    blocks.farValues = std::move(farValues);
    return blocks;
}

DensityColumn::ElementLists DensityColumn::sortByTile(
    std::span<const std::uint32_t> elements) const {
    ElementLists lists(mLayout.count.x());
    for (const std::uint32_t element : elements) {
        const openvdb::BBoxd bounds = mSource.elementBounds(element);
        const TileRange range =
            tilesTouching(mLayout, mPlan.halo, 0, bounds.min().x() / mLayout.voxelSize,
                          bounds.max().x() / mLayout.voxelSize);
        for (int x = range.first; x <= range.last; ++x) lists[x].push_back(element);
    }
    return lists;
}

// Spreads what matters to a tile onto the buffer, if it makes differences, and marks where it is.
SpreadBricks::Content DensityColumn::spreadTile(const openvdb::Coord& tile,
                                                const std::vector<std::uint32_t>& elements) {
    const openvdb::Vec3d offset = mFilter.regionOffset();
    SpreadBricks::Content content;
    if (mBricks != nullptr) {
        content = mBricks->contentOf(tile);
        if (content.samples == 0) return content;
        mBricks->mark(tile, openvdb::Coord::round(-offset), mNear);
    } else {
        // Collect the quadrature points.
        const SamplingRegion region{mLayout.voxelSize, mLayout.tileOrigin(tile).asVec3d() + offset,
                                    openvdb::Vec3d(mPlan.side)};
        mSamples.clear();
        for (const std::uint32_t element : elements) {
            mSource.sampleElement(element, region, mPlan.quadrature, mSamples);
        }
        if (mSamples.empty()) return content;
        mNear.mark(mSamples, -offset);
        content.samples = static_cast<std::int64_t>(mSamples.size());
        // A surface parallel to x makes no differences.
        content.hasDifferences =
            std::any_of(mSamples.begin(), mSamples.end(),
                        [](const SurfaceSample& sample) { return sample.areaVector.x() != 0; });
    }
    if (!content.hasDifferences) return content;
    std::fill_n(mBuffer.get(), mBufferSize, 0.0F);
    if (mBricks != nullptr) {
        mBricks->addTo(tile, mBuffer.get());
    } else {
        mFilter.spread(mSamples, mBuffer.get());
    }
    return content;
}

// Computes the tile's densities into mDensity. Returns false if no part of the surface is there.
bool DensityColumn::fillTile(const openvdb::Coord& tile, const std::vector<std::uint32_t>& elements,
                             ColumnStatistics& statistics) {
    const Stopwatch stopwatch;
    const SpreadBricks::Content content = spreadTile(tile, elements);
    if (content.samples == 0) return false;
    const double spreadSeconds = stopwatch.seconds();
    if (content.hasDifferences) mFilter.apply(mBuffer.get());
    statistics.spreadSeconds += spreadSeconds;
    statistics.transformSeconds += stopwatch.seconds() - spreadSeconds;
    statistics.samples += content.samples;
    ++statistics.tiles;
    sumTile(content.hasDifferences, statistics);
    return true;
}

// The running sum along x, from the tile before; cells far from the surface are snapped.
void DensityColumn::sumTile(bool hasDifferences, ColumnStatistics& statistics) {
    const int interior = mPlan.interior;
    constexpr int kCell = NearCells::kCell;
    for (int x = 0; x < interior; ++x) {
        for (int y = 0; y < interior && hasDifferences; ++y) {
            addRow(mFilter.row(mBuffer.get(), x, y), interior,
                   mSum.data() + static_cast<std::size_t>(y) * interior);
        }
        for (int y = 0; y < mNear.count(); ++y) {
            for (int z = 0; z < mNear.count(); ++z) {
                if (!mNear.isNear(x / kCell, y, z)) snapCell(y, z, statistics);
            }
        }
        const Extent found = roundTo(mSum, mDensity.data() + x * mSum.size());
        statistics.minimum = std::min<double>(statistics.minimum, found.low);
        statistics.maximum = std::max<double>(statistics.maximum, found.high);
    }
}

// Makes the sums of one cell's rows the whole number that they stand for, and measures how far
// they were from it.
void DensityColumn::snapCell(int y, int z, ColumnStatistics& statistics) {
    const int interior = mPlan.interior;
    constexpr int kCell = NearCells::kCell;
    const int yEnd = std::min((y + 1) * kCell, interior);
    const int zEnd = std::min((z + 1) * kCell, interior);
    const double whole =
        std::round(mSum[static_cast<std::size_t>(y) * kCell * interior + z * kCell]);
    for (int i = y * kCell; i < yEnd; ++i) {
        double* sum = mSum.data() + static_cast<std::size_t>(i) * interior;
        for (int j = z * kCell; j < zEnd; ++j) {
            statistics.addClosureError(std::abs(sum[j] - whole));
            sum[j] = whole;
        }
    }
    statistics.highestWinding = std::max(statistics.highestWinding, whole);
    statistics.lowestWinding = std::min(statistics.lowestWinding, whole);
}

// The same for a whole tile, which then has one value.
void DensityColumn::snapAll(ColumnStatistics& statistics) {
    const double whole = mSum[0];
    for (int y = 0; y < mNear.count(); ++y) {
        for (int z = 0; z < mNear.count(); ++z) snapCell(y, z, statistics);
    }
    for (double& sum : mSum) {
        statistics.addClosureError(std::abs(sum - std::round(whole)));
        sum = std::round(whole);
    }
}

void DensityColumn::storeTile(const openvdb::Coord& tileOrigin, BlockStore& store) const {
    const int interior = mPlan.interior;
    const openvdb::CoordBBox box = openvdb::CoordBBox::createCube(tileOrigin, interior);
    forEachBlock(box, [&](const openvdb::CoordBBox& part) {
        const openvdb::Coord at = part.min() - tileOrigin;
        const openvdb::Coord last = part.max() - tileOrigin;
        // A block whose cells are all far is constant.
        constexpr int kCell = NearCells::kCell;
        bool isNear = false;
        for (int x = at.x() / kCell; x <= last.x() / kCell; ++x) {
            for (int y = at.y() / kCell; y <= last.y() / kCell; ++y) {
                for (int z = at.z() / kCell; z <= last.z() / kCell; ++z) {
                    isNear = isNear || mNear.isNear(x, y, z);
                }
            }
        }
        const float* first = mDensity.data() +
                             (static_cast<std::size_t>(at.x()) * interior + at.y()) * interior +
                             at.z();
        if (isNear) {
            store.copy(part, first, static_cast<std::ptrdiff_t>(interior) * interior, interior);
        } else {
            store.fill(part, *first);
        }
    });
}

}  // namespace bandvox
