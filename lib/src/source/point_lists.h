#pragma once

#include <bandvox/core/parallel.h>
#include <bandvox/source/mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// Corners, edges or triangles of a mesh by the point that they belong to: those of point p are
/// items[start[p]] to items[start[p + 1] - 1], in rising order.
struct PointLists {
    std::vector<std::uint32_t> start;
    std::vector<std::uint32_t> items;

    std::span<const std::uint32_t> of(std::size_t point) const {
        return {items.data() + start[point], items.data() + start[point + 1]};
    }
};

/// Lists kItems·t + k, for each triangle t and k from 0 to kItems - 1, by pointOf(triangle, k),
/// which is below pointCount.
template <int kItems, typename PointOf>
PointLists listByPoint(const std::vector<openvdb::Vec3I>& triangles, std::size_t pointCount,
                       const PointOf& pointOf) {
    // Each block has points of its own, and looks at all triangles for theirs: so blocks share
    // nothing that they write to, and their number changes no list.
    constexpr std::size_t kMostBlocks = 8, kLeastPoints = 16384;
    const std::size_t blocks = std::clamp<std::size_t>(
        pointCount / kLeastPoints, 1,
        std::min<std::size_t>(kMostBlocks, static_cast<std::size_t>(threadCount())));
    const auto firstOf = [&](std::size_t block) { return pointCount * block / blocks; };
    const auto forEachOf = [&](std::size_t block, const auto& visit) {
        const auto begin = static_cast<std::uint32_t>(firstOf(block));
        const auto count = static_cast<std::uint32_t>(firstOf(block + 1)) - begin;
        std::uint32_t item = 0;
        for (const openvdb::Vec3I& t : triangles) {
            for (int k = 0; k < kItems; ++k, ++item) {
                const std::uint32_t point = pointOf(t, k);
                if (point - begin < count) visit(point, item);
            }
        }
    };

    // Count, then place.
    PointLists lists;
    lists.start.assign(pointCount + 1, 0);
    lists.items.resize(kItems * triangles.size());
    std::vector<std::uint32_t> total(blocks + 1, 0);
    parallelFor(static_cast<std::int64_t>(blocks), [&](std::int64_t i) {
        const auto block = static_cast<std::size_t>(i);
        std::uint32_t sum = 0;
        forEachOf(block, [&](std::uint32_t point, std::uint32_t) {
            ++lists.start[point];
            ++sum;
        });
        total[block + 1] = sum;
    });
    for (std::size_t block = 0; block < blocks; ++block) total[block + 1] += total[block];
    parallelFor(static_cast<std::int64_t>(blocks), [&](std::int64_t i) {
        const auto block = static_cast<std::size_t>(i);
        const std::size_t begin = firstOf(block), end = firstOf(block + 1);
        // Up to here each point's number of items; from here on where the next of them goes, which
        // in the end is where the next point's begin.
        std::uint32_t next = total[block];
        for (std::size_t p = begin; p < end; ++p) {
            next += lists.start[p];
            lists.start[p] = next - lists.start[p];
        }
        forEachOf(block, [&](std::uint32_t point, std::uint32_t item) {
            lists.items[lists.start[point]++] = item;
        });
        for (std::size_t p = end; p-- > begin + 1;) lists.start[p] = lists.start[p - 1];
        if (begin < end) lists.start[begin] = total[block];
    });
    lists.start[pointCount] = total[blocks];
    return lists;
}

}  // namespace bandvox
