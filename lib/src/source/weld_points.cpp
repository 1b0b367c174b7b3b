#include "source/weld_points.h"

#include "source/index_blocks.h"
#include "source/near_points.h"
#include "source/no_index.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// Side of a cell of the grid that finds near points, in tolerances: so large that most points
/// are far from their cell's border and need no look into a neighbour.
constexpr double kCellSide = 16.0;

std::uint64_t mix(std::uint64_t h) {
    // The finaliser of S. Vigna's splitmix64.
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
    return h ^ (h >> 31);
}

template <typename Key>
std::uint64_t hash(const Key& key) {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const auto part : key) h = mix(h + std::bit_cast<std::uint64_t>(part));
    return h;
}

/// From keys to numbers; open addressing, sized once.
template <typename Key>
class HashTable {
  public:
    explicit HashTable(std::size_t capacity)
        : mMask(std::bit_ceil(2 * capacity + 1) - 1), mEntries(mMask + 1) {}

    /// The number stored for `key`, kNoIndex at first.
    std::uint32_t& operator[](const Key& key) {
        std::size_t slot = hash(key) & mMask;
        while (mEntries[slot].used && mEntries[slot].key != key) slot = (slot + 1) & mMask;
        mEntries[slot].used = true;
        mEntries[slot].key = key;
        return mEntries[slot].value;
    }

    /// The number stored for `key`, or kNoIndex.
    std::uint32_t find(const Key& key) const {
        std::size_t slot = hash(key) & mMask;
        while (mEntries[slot].used && mEntries[slot].key != key) slot = (slot + 1) & mMask;
        return mEntries[slot].used ? mEntries[slot].value : kNoIndex;
    }

  private:
    struct Entry {
        Key key{};
        std::uint32_t value = kNoIndex;
        bool used = false;
    };
    std::size_t mMask;
    std::vector<Entry> mEntries;
};

/// Gives the triangles new point numbers.
void renumber(Mesh& mesh, const std::vector<std::uint32_t>& newIndex) {
    for (openvdb::Vec3I& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) t[i] = newIndex[t[i]];
    }
}

std::vector<std::uint32_t> weldEqual(std::vector<Vec3d>& points) {
    using Key = std::array<double, 3>;
    HashTable<Key> table(points.size());
    std::vector<std::uint32_t> newIndex(points.size());
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d p = points[i] + Vec3d(0.0);  // makes -0 a 0, which has other bits
        std::uint32_t& index = table[Key{p.x(), p.y(), p.z()}];
        if (index == kNoIndex) {
            index = count;
            points[count++] = p;
        }
        newIndex[i] = index;
    }
    points.resize(count);
    return newIndex;
}

/// Finds earlier points near a new one, with a hash of grid cells.
class NearPoints {
  public:
    NearPoints(double tolerance, std::size_t capacity)
        : mTolerance(tolerance), mCell(kCellSide * tolerance), mHeads(capacity) {
        mNext.reserve(capacity);
    }

    /// An added point within the tolerance of p, or kNoIndex.
    std::uint32_t find(const Vec3d& p, const std::vector<Vec3d>& points) const {
        const Key lower = cellOf(p - Vec3d(mTolerance));
        const Key upper = cellOf(p + Vec3d(mTolerance));
        for (std::int64_t x = lower[0]; x <= upper[0]; ++x) {
            for (std::int64_t y = lower[1]; y <= upper[1]; ++y) {
                for (std::int64_t z = lower[2]; z <= upper[2]; ++z) {
                    std::uint32_t i = mHeads.find(Key{x, y, z});
                    for (; i != kNoIndex; i = mNext[i]) {
                        if ((points[i] - p).lengthSqr() <= mTolerance * mTolerance) return i;
                    }
                }
            }
        }
        return kNoIndex;
    }

    /// Adds p as the point with the next number.
    void add(const Vec3d& p) {
        std::uint32_t& head = mHeads[cellOf(p)];
        mNext.push_back(std::exchange(head, static_cast<std::uint32_t>(mNext.size())));
    }

  private:
    using Key = std::array<std::int64_t, 3>;

    Key cellOf(const Vec3d& p) const {
        const auto along = [this](double x) {
            return static_cast<std::int64_t>(std::floor(x / mCell));
        };
        return {along(p.x()), along(p.y()), along(p.z())};
    }

    double mTolerance;
    double mCell;
    HashTable<Key> mHeads;
    std::vector<std::uint32_t> mNext;
};

std::vector<std::uint32_t> weldNear(std::vector<Vec3d>& points, double tolerance) {
    NearPoints near(tolerance, points.size());
    std::vector<std::uint32_t> newIndex(points.size());
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d p = points[i];
        std::uint32_t index = near.find(p, points);
        if (index == kNoIndex) {
            near.add(p);
            points[count] = p;
            index = count++;
        }
        newIndex[i] = index;
    }
    points.resize(count);
    return newIndex;
}

}  // namespace

void removeUnusedPoints(Mesh& mesh) {
    std::vector<std::uint8_t> used(mesh.points.size(), 0);
    forEachIndex(mesh.triangles.size(), [&](std::size_t t) {
        for (int i = 0; i < 3; ++i) {
            std::atomic_ref<std::uint8_t> mark(used[mesh.triangles[t][i]]);
            if (mark.load(std::memory_order_relaxed) == 0) mark.store(1, std::memory_order_relaxed);
        }
    });
    if (std::count(used.begin(), used.end(), 0) == 0) return;
    std::vector<std::uint32_t> newIndex(mesh.points.size(), kNoIndex);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (used[i] == 0) continue;
        mesh.points[count] = mesh.points[i];
        newIndex[i] = count++;
    }
    mesh.points.resize(count);
    renumber(mesh, newIndex);
}

std::size_t weldPoints(Mesh& mesh, double tolerance) {
    const std::size_t before = mesh.points.size();
    const std::vector<std::uint32_t> newIndex = weld(mesh.points, tolerance);
    if (mesh.points.size() < before) renumber(mesh, newIndex);
    return before - mesh.points.size();
}

std::size_t dropCollapsed(Mesh& mesh) {
    return std::erase_if(mesh.triangles, [](const openvdb::Vec3I& t) {
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    });
}

std::vector<std::uint32_t> weld(std::vector<Vec3d>& points, double tolerance) {
    // Below the rounding of doubles a tolerance means equality, and cell numbers would overflow.
    double largest = 0.0;
    for (const Vec3d& p : points) {
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis]));
    }
    const bool isNearEnough = tolerance > 1e-15 * largest;
    if (!haveNearPoints(points, isNearEnough ? tolerance : 0)) {
        std::vector<std::uint32_t> sameIndex(points.size());
        std::iota(sameIndex.begin(), sameIndex.end(), 0U);
        for (Vec3d& p : points) p += Vec3d(0.0);  // as weldEqual does
        return sameIndex;
    }
    std::vector<std::uint32_t> newIndex = weldEqual(points);
    if (isNearEnough) {
        const std::vector<std::uint32_t> ofEqual = weldNear(points, tolerance);
        for (std::uint32_t& index : newIndex) index = ofEqual[index];
    }
    return newIndex;
}

}  // namespace bandvox
