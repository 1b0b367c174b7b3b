#include "source/triangle_order.h"

#include "source/index_blocks.h"
#include "source/mesh_bounds.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cstddef>
#include <tuple>

// G. M. Morton: "A Computer Oriented Geodetic Data Base; and a New Technique in File Sequencing"
// (1966).

namespace bandvox {
namespace {

using openvdb::Vec3d;

constexpr int kBitsOfAxis = 21;
constexpr int kBitsOfBucket = 12;
constexpr std::size_t kBuckets = std::size_t{1} << kBitsOfBucket;

/// Puts two zeros before each bit.
std::uint64_t spreadBits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// Where triangles lie on the curve.
class CurvePlaces {
  public:
    explicit CurvePlaces(const Mesh& mesh) : mMesh(mesh) {
        const openvdb::BBoxd box = boundsOf(mesh);
        const Vec3d size = box.extents();
        const double longest = std::max({size.x(), size.y(), size.z()});
        constexpr double kCells = 1 << kBitsOfAxis;
        mLow = box.min();
        // Of a box without a size, or one too large for its size to be a number, all are in order.
        mScale = longest > 0 ? (kCells - 1) / longest : 0;
        if (!(mScale * longest <= kCells)) mScale = 0;
    }

    std::uint64_t operator()(std::size_t triangle) const {
        if (mScale == 0) return 0;
        const openvdb::Vec3I& t = mMesh.triangles[triangle];
        std::uint64_t place = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = mMesh.points[t[0]][axis] - mLow[axis];
            const double b = mMesh.points[t[1]][axis] - mLow[axis];
            const double c = mMesh.points[t[2]][axis] - mLow[axis];
            const double middle = 0.5 * (std::min({a, b, c}) + std::max({a, b, c}));
            const auto cell = static_cast<std::uint64_t>(mScale * middle);
            place |= spreadBits(cell) << axis;
        }
        return place;
    }

  private:
    const Mesh& mMesh;
    Vec3d mLow;
    double mScale;
};

struct Entry {
    std::uint64_t place;
    std::uint32_t triangle;
};

}  // namespace

std::vector<std::uint32_t> orderAlongCurve(const Mesh& mesh) {
    const std::size_t count = mesh.triangles.size();
    const CurvePlaces placeOf(mesh);
    const auto bucketOf = [](std::uint64_t place) {
        return static_cast<std::size_t>(place >> (3 * kBitsOfAxis - kBitsOfBucket));
    };

    // Count what each part of the mesh puts into each bucket; turn that into where it goes.
    constexpr std::size_t kPart = 1 << 17;
    const std::size_t parts = (count + kPart - 1) / kPart;
    std::vector<std::uint32_t> next(parts * kBuckets, 0);
    const auto forEachOf = [&](std::int64_t part, const auto& visit) {
        const std::size_t begin = static_cast<std::size_t>(part) * kPart;
        std::uint32_t* row = next.data() + static_cast<std::size_t>(part) * kBuckets;
        for (std::size_t i = begin; i < std::min(begin + kPart, count); ++i) {
            const std::uint64_t place = placeOf(i);
            visit(Entry{place, static_cast<std::uint32_t>(i)}, row[bucketOf(place)]);
        }
    };
    parallelFor(static_cast<std::int64_t>(parts), [&](std::int64_t part) {
        forEachOf(part, [](const Entry&, std::uint32_t& n) { ++n; });
    });
    std::vector<std::uint32_t> start(kBuckets + 1, 0);
    for (std::size_t bucket = 0, sum = 0; bucket < kBuckets; ++bucket) {
        start[bucket] = static_cast<std::uint32_t>(sum);
        for (std::size_t part = 0; part < parts; ++part) {
            std::uint32_t& n = next[part * kBuckets + bucket];
            sum += n;
            n = static_cast<std::uint32_t>(sum) - n;
        }
        start[bucket + 1] = static_cast<std::uint32_t>(sum);
    }

    // Put all into their buckets, and each bucket in order.
    std::vector<Entry> entries(count);
    parallelFor(static_cast<std::int64_t>(parts), [&](std::int64_t part) {
        forEachOf(part, [&](const Entry& entry, std::uint32_t& n) { entries[n++] = entry; });
    });
    std::vector<std::uint32_t> order(count);
    constexpr std::size_t kBucketsOfTask = 16;
    parallelFor(kBuckets / kBucketsOfTask, [&](std::int64_t task) {
        const std::size_t first = static_cast<std::size_t>(task) * kBucketsOfTask;
        for (std::size_t bucket = first; bucket < first + kBucketsOfTask; ++bucket) {
            const auto begin = entries.begin() + start[bucket];
            const auto end = entries.begin() + start[bucket + 1];
            std::sort(begin, end, [](const Entry& a, const Entry& b) {
                return std::tie(a.place, a.triangle) < std::tie(b.place, b.triangle);
            });
            std::transform(begin, end, order.begin() + start[bucket],
                           [](const Entry& entry) { return entry.triangle; });
        }
    });
    return order;
}

}  // namespace bandvox
