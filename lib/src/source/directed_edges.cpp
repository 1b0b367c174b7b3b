#include "source/directed_edges.h"

#include <utility>

namespace bandvox {

PointLists listEdges(const DirectedEdges& edges, std::size_t pointCount) {
    PointLists lists = listByPoint<3>(
        edges.triangles(), pointCount,
        [](const openvdb::Vec3I& t, int k) { return std::min(t[k], t[(k + 1) % 3]); });
    forEachIndexBlock(pointCount, [&](std::size_t firstPoint, std::size_t endPoint) {
        // An edge's number, below its higher end.
        std::vector<std::uint64_t> keys;
        for (std::size_t p = firstPoint; p < endPoint; ++p) {
            keys.clear();
            std::uint32_t* items = lists.items.data() + lists.start[p];
            const std::size_t count = lists.start[p + 1] - lists.start[p];
            for (std::size_t i = 0; i < count; ++i) {
                keys.push_back(std::uint64_t{edges.high(items[i])} << 32 | items[i]);
            }
            std::sort(keys.begin(), keys.end());
            for (std::size_t i = 0; i < count; ++i) items[i] = static_cast<std::uint32_t>(keys[i]);
        }
    });
    return lists;
}

std::vector<std::uint32_t> groupEdges(const DirectedEdges& edges, std::size_t pointCount) {
    return std::move(listEdges(edges, pointCount).items);
}

}  // namespace bandvox
