#include "scatter/space_points.h"

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

constexpr std::uint64_t kCellMiddle = std::uint64_t(1) << 20U;

std::uint64_t keyOfCell(const SpaceNet::Place& cell) {
    const auto part = [&](std::size_t axis) {
        return static_cast<std::uint64_t>(cell[axis] + static_cast<std::int64_t>(kCellMiddle));
    };
    return part(0) << 42U | part(1) << 21U | part(2);
}

double squareOfDistance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    const double x = a[0] - b[0];
    const double y = a[1] - b[1];
    const double z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/// Calls body(cell) for the cells of the ring that is `ring` cells around one.
template <typename Body>
void forRing(const SpaceNet::Place& middle, int ring, const Body& body) {
    for (int x = -ring; x <= ring; ++x) {
        for (int y = -ring; y <= ring; ++y) {
            const bool isFace = std::abs(x) == ring || std::abs(y) == ring;
            for (int z = -ring; z <= ring; z += isFace || ring == 0 ? 1 : 2 * ring) {
                body(SpaceNet::Place{middle[0] + x, middle[1] + y, middle[2] + z});
            }
        }
    }
}

}  // namespace

std::size_t countOccupied(const SortedSpacePoints& points, int level) {
    std::size_t count = 0;
    SpaceNet::Place last{-1, -1, -1};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SpaceNet::Place cell = points.cell(i, level);
        if (cell != last) ++count;
        last = cell;
    }
    return count;
}

OccupiedCells::OccupiedCells(const SortedSpacePoints& points, int level, const Progress& progress)
    : mPoints(points), mLevel(level) {
    constexpr std::size_t kBetweenLooks = std::size_t(1) << 16U;
    for (std::size_t begin = 0; begin < points.size();) {
        if (mInOrder.size() % kBetweenLooks == 0) progress.throwIfInterrupted();
        const SpaceNet::Place cell = points.cell(begin, level);
        std::size_t end = begin + 1;
        while (end < points.size() && points.cell(end, level) == cell) ++end;
        const PointRange range{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
        mCells[keyOfCell(cell)] = range;
        mInOrder.push_back(range);
        begin = end;
    }
}

std::pair<std::uint32_t, std::uint32_t> OccupiedCells::pointsOf(const SpaceNet::Place& cell) const {
    const auto found = mCells.find(keyOfCell(cell));
    return found == mCells.end() ? std::pair{0U, 0U} : found->second;
}

SpaceNet OccupiedCells::places() const {
    SpaceNet net;
    for (std::size_t i = 0; i < mPoints.size(); ++i) net.add(mPoints.cell(i, mLevel));
    net.sort();
    return net;
}

double OccupiedCells::nearest(std::size_t i) const {
    const double side = std::ldexp(1.0, -mLevel);
    const SpaceNet::Place own = mPoints.cell(i, mLevel);
    constexpr int kFarthest = 8;
    const double farthest = kFarthest * side;
    double least = farthest * farthest;
    for (int ring = 0; ring <= kFarthest; ++ring) {
        if (ring > 1 && (ring - 1) * side * ((ring - 1) * side) > least) break;
        forRing(own, ring, [&](const SpaceNet::Place& cell) {
            const auto [begin, end] = pointsOf(cell);
            for (std::size_t other = begin; other < end; ++other) {
                if (other == i) continue;
                least = std::min(least, squareOfDistance(mPoints.at[i], mPoints.at[other]));
            }
        });
    }
    return std::sqrt(least);
}

std::vector<std::uint32_t> OccupiedCells::pointsNear(const SpaceNet::Place& cell,
                                                     double reach) const {
    const auto gap = [](int a, int b) { return std::max(std::abs(a - b) - 1, 0); };
    std::vector<std::pair<double, PointRange>> near;
    const auto takeIfNear = [&](const SpaceNet::Place& other, const PointRange& range) {
        const double distance =
            std::hypot(gap(cell[0], other[0]), gap(cell[1], other[1]), gap(cell[2], other[2]));
        if (distance <= reach && range.first < range.second) near.emplace_back(distance, range);
    };
    const int rings = static_cast<int>(std::floor(reach)) + 1;
    if (static_cast<double>(mInOrder.size()) < std::pow(2 * rings + 1, 3)) {
        for (const PointRange& range : mInOrder)
            takeIfNear(mPoints.cell(range.first, mLevel), range);
    } else {
        for (int ring = 0; ring <= rings; ++ring) {
            forRing(cell, ring,
                    [&](const SpaceNet::Place& other) { takeIfNear(other, pointsOf(other)); });
        }
    }
    std::sort(near.begin(), near.end());
    std::vector<std::uint32_t> found;
    for (const auto& [distance, range] : near) {
        for (std::uint32_t i = range.first; i < range.second; ++i) found.push_back(i);
    }
    return found;
}

}  // namespace bandvox
