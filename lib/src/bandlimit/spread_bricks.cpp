#include "bandlimit/spread_bricks.h"

#include "core/stopwatch.h"
#include "core/worker_pool.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

namespace bandvox {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

/// Of a surface of so many elements per square voxel each sample costs more than what bricks do.
constexpr double kDense = 6;

/// Longest side of a brick, voxels; a voxel's number has 5 bits along each axis.
constexpr int kLongestSide = 24;
constexpr int kBitsOfSide = 5;

/// An element's samples are within its box, but for rounding; voxels.
constexpr double kRounding = 1e-6;

/// More samples than this are summed up so many at a time, as single precision would add each of
/// millions to the sum of all others.
constexpr std::size_t kFewOfBrick = 1U << 16;
constexpr std::size_t kOfBrickTogether = 4096;

}  // namespace

SpreadBricks::Axis::Axis(int tiles, int interiorOfTile, int sideOfTile)
    : interior(interiorOfTile), side(sideOfTile) {
    std::vector<int> ends;
    for (int i = 0; i < tiles; ++i) {
        ends.push_back(i * interior);
        ends.push_back(i * interior + side);
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const int length = ends[i + 1] - ends[i];
        const int parts = (length + kLongestSide - 1) / kLongestSide;
        for (int k = 0; k < parts; ++k) cuts.push_back(ends[i] + length * k / parts);
    }
    cuts.push_back(ends.back());
    for (int brick = 0; brick < count(); ++brick) {
        brickOf.insert(brickOf.end(), cuts[brick + 1] - cuts[brick], brick);
    }
}

// The brick at a place, or the nearest.
int SpreadBricks::Axis::at(double place) const {
    const auto last = static_cast<double>(brickOf.size() - 1);
    return brickOf[static_cast<std::size_t>(std::clamp(place, 0.0, last))];
}

/// Fills columns of bricks, one after the other; each thread has its own.
class SpreadBricks::Filler {
  public:
    explicit Filler(const SpreadBricks& bricks)
        : mBricks(bricks),
          mYCount(kLongestSide + bricks.mFilter.reachBehind()),
          mZStride(kLongestSide + bricks.mFilter.shift() + bricks.mPlan.kernel.paddedWidth() + 1),
          mNodes(static_cast<std::size_t>(mYCount) * mYCount * mZStride),
          mHolds(std::size_t{1} << (3 * kBitsOfSide)) {}

    Column fill(int y, int z, std::span<const std::uint32_t> elements);

  private:
    void spread(float offset);
    void keepRows(Brick& brick);
    void keepVoxels(Brick& brick);

    const SpreadBricks& mBricks;
    int mYCount, mZStride;
    std::vector<float> mNodes, mSum;
    std::vector<std::uint8_t> mHolds;
    std::vector<SurfaceSample> mSamples;
};

SpreadBricks::Column SpreadBricks::Filler::fill(int y, int z,
                                                std::span<const std::uint32_t> elements) {
    const std::array<Axis, 3>& axes = mBricks.mAxes;
    std::vector<std::vector<std::uint32_t>> lists(axes[0].count());
    for (const std::uint32_t element : elements) {
        const openvdb::BBoxd box = mBricks.mSource.elementBounds(element);
        const double size = mBricks.mLayout.voxelSize, origin = mBricks.mOrigin.x();
        const int last = axes[0].at(box.max().x() / size - origin + kRounding);
        for (int x = axes[0].at(box.min().x() / size - origin - kRounding); x <= last; ++x) {
            lists[x].push_back(element);
        }
    }
    Column column;
    for (int x = 0; x < axes[0].count(); ++x) {
        if (lists[x].empty()) continue;
        const Coord low(axes[0].cuts[x], axes[1].cuts[y], axes[2].cuts[z]);
        const Coord high(axes[0].cuts[x + 1], axes[1].cuts[y + 1], axes[2].cuts[z + 1]);
        const SamplingRegion region{mBricks.mLayout.voxelSize, mBricks.mOrigin + low.asVec3d(),
                                    (high - low).asVec3d()};
        mSamples.clear();
        for (const std::uint32_t element : lists[x]) {
            mBricks.mSource.sampleElement(element, region, mBricks.mPlan.quadrature, mSamples);
        }
        if (mSamples.empty()) continue;
        Brick brick{x, static_cast<std::uint32_t>(mSamples.size()), false, {}, {}, {}};
        keepVoxels(brick);
        brick.hasDifferences =
            std::any_of(mSamples.begin(), mSamples.end(),
                        [](const SurfaceSample& sample) { return sample.areaVector.x() != 0; });
        if (brick.hasDifferences) {
            spread(static_cast<float>(mBricks.mFilter.shift()));
            keepRows(brick);
        }
        column.push_back(std::move(brick));
    }
    return column;
}

void SpreadBricks::Filler::spread(float offset) {
    const SpreadLattice lattice{mNodes.data(), mYCount, mZStride};
    std::span<const SurfaceSample> samples = mSamples;
    if (samples.size() <= kFewOfBrick) {
        spreadSamples(samples, offset, mBricks.mPlan.kernel, lattice);
        return;
    }
    mSum.assign(mNodes.size(), 0.0F);
    while (!samples.empty()) {
        const auto some = samples.first(std::min(samples.size(), kOfBrickTogether));
        samples = samples.subspan(some.size());
        spreadSamples(some, offset, mBricks.mPlan.kernel, lattice);
        for (std::size_t i = 0; i < mNodes.size(); ++i) {
            mSum[i] += std::exchange(mNodes[i], 0.0F);
        }
    }
    mNodes.swap(mSum);
}

// Moves what is not 0 into the brick, and leaves zeros.
void SpreadBricks::Filler::keepRows(Brick& brick) {
    for (int x = 0; x < mYCount; ++x) {
        for (int y = 0; y < mYCount; ++y) {
            float* row = mNodes.data() + (static_cast<std::size_t>(x) * mYCount + y) * mZStride;
            int begin = 0, end = mZStride;
            while (end > 0 && row[end - 1] == 0) --end;
            while (begin < end && row[begin] == 0) ++begin;
            if (begin == end) continue;
            brick.rows.push_back({static_cast<std::uint32_t>(brick.values.size()),
                                  static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                  static_cast<std::uint8_t>(begin),
                                  static_cast<std::uint8_t>(end - begin)});
            brick.values.insert(brick.values.end(), row + begin, row + end);
            std::fill(row + begin, row + end, 0.0F);
        }
    }
    brick.rows.shrink_to_fit();
    brick.values.shrink_to_fit();
}

void SpreadBricks::Filler::keepVoxels(Brick& brick) {
    for (const SurfaceSample& sample : mSamples) {
        std::size_t voxel = 0;
        for (int axis = 0; axis < 3; ++axis) {
            // Rounding to single precision may have made it the brick's end.
            const int at =
                std::min(static_cast<int>(sample.position[axis]), (1 << kBitsOfSide) - 1);
            voxel = voxel << kBitsOfSide | static_cast<std::size_t>(at);
        }
        if (std::exchange(mHolds[voxel], std::uint8_t{1}) == 0) {
            brick.voxels.push_back(static_cast<std::uint16_t>(voxel));
        }
    }
    for (const std::uint16_t voxel : brick.voxels) mHolds[voxel] = 0;
    brick.voxels.shrink_to_fit();
}

bool SpreadBricks::payFor(const BoundarySource& source, double voxelSize) {
    const double area = source.area() / (voxelSize * voxelSize);
    return static_cast<double>(source.elementCount()) >= kDense * area;
}

double SpreadBricks::estimateMemory(const BoundarySource& source, const TilePlan& plan,
                                    double voxelSize) {
    // A surface meets half as many bricks again as its area has squares of their size, and of the
    // nodes of each about half.
    constexpr double kUsualSide = 16, kBricksOfSquare = 1.5, kUsed = 0.5;
    const double area = source.area() / (voxelSize * voxelSize);
    const double nodes = std::pow(kUsualSide + plan.kernel.width(), 3);
    return (1 + area * kBricksOfSquare / (kUsualSide * kUsualSide)) * kUsed * nodes * sizeof(float);
}

std::int64_t SpreadBricks::steps(const TilePlan& plan, const TileLayout& layout) {
    const auto bricksAlong = [&](int axis) {
        return Axis(layout.count[axis], layout.interior, plan.side).count();
    };
    return static_cast<std::int64_t>(bricksAlong(1)) * bricksAlong(2);
}

SpreadBricks::SpreadBricks(const BoundarySource& source, const TilePlan& plan,
                           const TileLayout& layout, const TileFilter& filter,
                           const std::vector<bool>& wanted)
    : mSource(source),
      mPlan(plan),
      mLayout(layout),
      mFilter(filter),
      mOrigin(layout.origin.asVec3d() + filter.regionOffset()) {
    for (int axis = 0; axis < 3; ++axis) {
        mAxes[axis] = Axis(layout.count[axis], layout.interior, plan.side);
    }
    mBins = binElements(bricksOf(wanted));
    mColumns.resize(mBins.start.size() - 1);
}

SpreadBricks::SpreadBricks(const BoundarySource& source, const TilePlan& plan,
                           const TileLayout& layout, const TileFilter& filter,
                           const std::vector<bool>& wanted, Progress& progress)
    : SpreadBricks(source, plan, layout, filter, wanted) {
    spread({0, layout.count.y() - 1}, progress);
}

void SpreadBricks::spread(const TileRange& rows, Progress& progress) {
    const int begin = std::max(mEnd, mAxes[1].first(rows.first));
    const int end = std::max(begin, mAxes[1].last(rows.last) + 1);
    const int zCount = mAxes[2].count();
    std::vector<double> seconds(static_cast<std::size_t>(end - begin) * zCount, 0);
    WorkerPool<Filler> pool([&] { return std::make_unique<Filler>(*this); });
    parallelFor(static_cast<std::int64_t>(seconds.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const int y = begin + static_cast<int>(i / zCount);
        const int z = static_cast<int>(i % zCount);
        const std::size_t column = static_cast<std::size_t>(y) * zCount + z;
        const auto elements = mBins.bin(column);
        if (!elements.empty()) {
            const Stopwatch stopwatch;
            std::unique_ptr<Filler> filler = pool.take();
            mColumns[column] = filler->fill(y, z, elements);
            pool.giveBack(std::move(filler));
            seconds[i] = stopwatch.seconds();
        }
        progress.advance();
    });
    for (const double part : seconds) mSeconds += part;
    for (int y = begin; y < end; ++y) mMemory += memoryOf(y);
    mEnd = end;
    if (mEnd == mAxes[1].count()) mBins = {};
}

void SpreadBricks::dropBefore(int row) {
    if (row >= mLayout.count.y()) return;
    const int end = std::min(mAxes[1].first(row), mEnd);
    for (; mFirst < end; ++mFirst) {
        mMemory -= memoryOf(mFirst);
        for (int z = 0; z < mAxes[2].count(); ++z) {
            Column().swap(mColumns[static_cast<std::size_t>(mFirst) * mAxes[2].count() + z]);
        }
    }
}

std::size_t SpreadBricks::Brick::memory() const {
    return sizeof(Brick) + rows.capacity() * sizeof(Row) + values.capacity() * sizeof(float) +
           voxels.capacity() * sizeof(voxels[0]);
}

std::size_t SpreadBricks::memoryOf(int y) const {
    std::size_t bytes = 0;
    for (int z = 0; z < mAxes[2].count(); ++z) {
        for (const Brick& brick : mColumns[static_cast<std::size_t>(y) * mAxes[2].count() + z]) {
            bytes += brick.memory();
        }
    }
    return bytes;
}

// Which columns of bricks matter to columns of tiles; empty for all.
std::vector<bool> SpreadBricks::bricksOf(const std::vector<bool>& wantedTiles) const {
    if (wantedTiles.empty()) return {};
    const Axis &ys = mAxes[1], &zs = mAxes[2];
    std::vector<bool> bricks(static_cast<std::size_t>(ys.count()) * zs.count());
    for (int y = 0; y < mLayout.count.y(); ++y) {
        for (int z = 0; z < mLayout.count.z(); ++z) {
            if (!wantedTiles[static_cast<std::size_t>(y) * mLayout.count.z() + z]) continue;
            for (int i = ys.first(y); i <= ys.last(y); ++i) {
                for (int j = zs.first(z); j <= zs.last(z); ++j) {
                    bricks[static_cast<std::size_t>(i) * zs.count() + j] = true;
                }
            }
        }
    }
    return bricks;
}

// The elements of each column of bricks.
Bins SpreadBricks::binElements(const std::vector<bool>& wantedBricks) const {
    const auto forEachColumn = [&](std::size_t element, const auto& visit) {
        const openvdb::BBoxd box = mSource.elementBounds(element);
        const Vec3d low = box.min() / mLayout.voxelSize - mOrigin - Vec3d(kRounding);
        const Vec3d high = box.max() / mLayout.voxelSize - mOrigin + Vec3d(kRounding);
        const int lastY = mAxes[1].at(high.y()), lastZ = mAxes[2].at(high.z());
        for (int y = mAxes[1].at(low.y()); y <= lastY; ++y) {
            for (int z = mAxes[2].at(low.z()); z <= lastZ; ++z) {
                const std::size_t column = static_cast<std::size_t>(y) * mAxes[2].count() + z;
                if (wantedBricks.empty() || wantedBricks[column]) visit(column);
            }
        }
    };
    return sortIntoBins(mSource.elementCount(),
                        static_cast<std::size_t>(mAxes[1].count()) * mAxes[2].count(),
                        forEachColumn);
}

// Calls visit(brick, low) for each brick of a tile's region; `low` is its first voxel there.
template <typename Visit>
void SpreadBricks::forEachBrick(const Coord& tile, const Visit& visit) const {
    const Axis& xs = mAxes[0];
    const Coord region(tile.x() * mLayout.interior, tile.y() * mLayout.interior,
                       tile.z() * mLayout.interior);
    for (int y = mAxes[1].first(tile.y()); y <= mAxes[1].last(tile.y()); ++y) {
        for (int z = mAxes[2].first(tile.z()); z <= mAxes[2].last(tile.z()); ++z) {
            const Column& column = mColumns[static_cast<std::size_t>(y) * mAxes[2].count() + z];
            auto brick =
                std::lower_bound(column.begin(), column.end(), xs.first(tile.x()),
                                 [](const Brick& a, int alongX) { return a.alongX < alongX; });
            for (; brick != column.end() && brick->alongX <= xs.last(tile.x()); ++brick) {
                const Coord low(xs.cuts[brick->alongX], mAxes[1].cuts[y], mAxes[2].cuts[z]);
                visit(*brick, low - region);
            }
        }
    }
}

SpreadBricks::Content SpreadBricks::contentOf(const Coord& tile) const {
    Content content;
    forEachBrick(tile, [&](const Brick& brick, const Coord&) {
        content.samples += brick.samples;
        content.hasDifferences = content.hasDifferences || brick.hasDifferences;
    });
    return content;
}

void SpreadBricks::mark(const Coord& tile, const Coord& interiorAt, NearCells& near) const {
    near.clear();
    forEachBrick(tile, [&](const Brick& brick, const Coord& low) {
        constexpr int kMask = (1 << kBitsOfSide) - 1;
        for (const std::uint16_t voxel : brick.voxels) {
            const Coord inBrick(voxel >> (2 * kBitsOfSide), voxel >> kBitsOfSide & kMask,
                                voxel & kMask);
            near.add(low + inBrick - interiorAt);
        }
    });
    near.widen();
}

void SpreadBricks::addTo(const Coord& tile, float* buffer) const {
    const SpreadLattice lattice = mFilter.lattice(buffer);
    forEachBrick(tile, [&](const Brick& brick, const Coord& low) {
        for (const Row& row : brick.rows) {
            const std::ptrdiff_t x = low.x() + row.x, y = low.y() + row.y;
            float* to =
                lattice.nodes + (x * lattice.yCount + y) * lattice.zStride + low.z() + row.begin;
            const float* from = brick.values.data() + row.value;
            for (int i = 0; i < row.count; ++i) to[i] += from[i];
        }
    });
}

bool SpreadBricks::isInColumn(int y, int z) const {
    for (int i = mAxes[1].first(y); i <= mAxes[1].last(y); ++i) {
        for (int j = mAxes[2].first(z); j <= mAxes[2].last(z); ++j) {
            if (!mColumns[static_cast<std::size_t>(i) * mAxes[2].count() + j].empty()) return true;
        }
    }
    return false;
}

}  // namespace bandvox
