#include "source/near_points.h"

#include "source/index_blocks.h"
#include "source/no_index.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// Side of a cell, in tolerances: so large that few points are near a border of theirs.
constexpr double kCellSide = 32;

/// The same, in units of the largest coordinate, at least: cells are numbered by whole numbers.
constexpr double kSmallestCell = 1e-12;

/// A point that may lie in a cell, which is known by its hash.
struct CellEntry {
    std::uint32_t hash, point;
};

/// The cells of a lattice that points lie in, or are near to.
class NearCellsOfPoints {
  public:
    NearCellsOfPoints(const std::vector<Vec3d>& points, double tolerance)
        : mPoints(points), mTolerance(tolerance) {
        double largest = 0;
        for (const Vec3d& p : points) {
            for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis]));
        }
        const double side = std::max(kCellSide * tolerance, kSmallestCell * largest);
        mCells = side > 0 ? 1 / side : 1;
    }

    /// Calls visit(entry) for each cell that holds a place no farther than the tolerance from the
    /// point, along the axes.
    template <typename Visit>
    void forEachCell(std::uint32_t point, const Visit& visit) const {
        std::int64_t low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = along(mPoints[point][axis] - mTolerance);
            high[axis] = along(mPoints[point][axis] + mTolerance);
        }
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                    visit(CellEntry{hashOf(x, y, z), point});
                }
            }
        }
    }

    bool areNear(std::uint32_t a, std::uint32_t b) const {
        if (a == b) return false;
        if (mTolerance == 0) return mPoints[a] == mPoints[b];  // squares may underflow
        return (mPoints[a] - mPoints[b]).lengthSqr() <= mTolerance * mTolerance;
    }

  private:
    std::int64_t along(double x) const { return static_cast<std::int64_t>(std::floor(x * mCells)); }

    static std::uint32_t hashOf(std::int64_t x, std::int64_t y, std::int64_t z) {
        // Odd numbers without a pattern in their bits, and a mixture of all bits in the high ones.
        const std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15U ^
                                static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fU ^
                                static_cast<std::uint64_t>(z) * 0xd6e8feb86659fd93U;
        return static_cast<std::uint32_t>(((h ^ h >> 32) * 0xd6e8feb86659fd93U) >> 32);
    }

    const std::vector<Vec3d>& mPoints;
    double mTolerance, mCells;
};

/// True if any two points of the entries, which are of cells with the same first bits of their
/// hash, are near each other. `shift`: so many bits of a hash follow those.
bool haveNearEntries(const NearCellsOfPoints& cells, const CellEntry* begin, std::size_t count,
                     int shift) {
    // Those that share a slot follow each other from its head.
    const std::size_t slots = std::bit_ceil(2 * count + 1);
    const int drop = std::max(0, shift - std::countr_zero(slots));
    std::vector<std::uint32_t> head(slots, kNoIndex), next(count, kNoIndex);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t slot = begin[i].hash >> drop & (slots - 1);
        for (std::uint32_t k = head[slot]; k != kNoIndex; k = next[k]) {
            if (cells.areNear(begin[i].point, begin[k].point)) return true;
        }
        next[i] = head[slot];
        head[slot] = i;
    }
    return false;
}

}  // namespace

bool haveNearPoints(const std::vector<Vec3d>& points, double tolerance) {
    const NearCellsOfPoints cells(points, tolerance);
    // Entries go into buckets by the first bits of their hash, each of which is then small.
    constexpr std::size_t kPerBucket = 8192;
    const int bits = std::min(12, static_cast<int>(std::bit_width(points.size() / kPerBucket)));
    const std::size_t buckets = std::size_t{1} << bits;
    const int shift = 32 - bits;
    const auto bucketOf = [&](const CellEntry& entry) {
        return static_cast<std::size_t>(std::uint64_t{entry.hash} >> shift);
    };

    // Count what each part of the points puts into each; turn that into where it goes.
    constexpr std::size_t kPart = std::size_t{1} << 17;
    const std::size_t parts = (points.size() + kPart - 1) / kPart;
    std::vector<std::size_t> next(parts * buckets, 0);
    const auto forEachOf = [&](std::int64_t part, const auto& visit) {
        const std::size_t begin = static_cast<std::size_t>(part) * kPart;
        std::size_t* row = next.data() + static_cast<std::size_t>(part) * buckets;
        for (std::size_t i = begin; i < std::min(begin + kPart, points.size()); ++i) {
            cells.forEachCell(static_cast<std::uint32_t>(i),
                              [&](const CellEntry& entry) { visit(entry, row[bucketOf(entry)]); });
        }
    };
    parallelFor(static_cast<std::int64_t>(parts), [&](std::int64_t part) {
        forEachOf(part, [](const CellEntry&, std::size_t& n) { ++n; });
    });
    std::vector<std::size_t> start(buckets + 1, 0);
    for (std::size_t bucket = 0, sum = 0; bucket < buckets; ++bucket) {
        for (std::size_t part = 0; part < parts; ++part) {
            std::size_t& n = next[part * buckets + bucket];
            sum += n;
            n = sum - n;
        }
        start[bucket + 1] = sum;
    }
    std::vector<CellEntry> entries(start.back());
    parallelFor(static_cast<std::int64_t>(parts), [&](std::int64_t part) {
        forEachOf(part, [&](const CellEntry& entry, std::size_t& n) { entries[n++] = entry; });
    });

    std::atomic<bool> found = false;
    parallelFor(static_cast<std::int64_t>(buckets), [&](std::int64_t i) {
        const auto bucket = static_cast<std::size_t>(i);
        if (found) return;
        if (haveNearEntries(cells, entries.data() + start[bucket],
                            start[bucket + 1] - start[bucket], shift)) {
            found = true;
        }
    });
    return found;
}

}  // namespace bandvox
