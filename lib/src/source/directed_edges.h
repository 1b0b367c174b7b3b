#pragma once

#include "source/index_blocks.h"
#include "source/point_lists.h"

#include <bandvox/source/mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// Directed edges: number 3·t + k runs from corner k of triangle t to the next.
class DirectedEdges {
  public:
    explicit DirectedEdges(const Mesh& mesh) : mTriangles(mesh.triangles) {}

    const std::vector<openvdb::Vec3I>& triangles() const { return mTriangles; }
    std::size_t count() const { return 3 * mTriangles.size(); }
    std::uint32_t from(std::uint32_t e) const { return mTriangles[e / 3][e % 3]; }
    std::uint32_t to(std::uint32_t e) const { return mTriangles[e / 3][(e + 1) % 3]; }
    std::uint32_t low(std::uint32_t e) const { return std::min(from(e), to(e)); }
    std::uint32_t high(std::uint32_t e) const { return std::max(from(e), to(e)); }
    bool rises(std::uint32_t e) const { return from(e) < to(e); }

  private:
    const std::vector<openvdb::Vec3I>& mTriangles;
};

/// All directed edges by their lower end, those of equal ends side by side and in rising order.
PointLists listEdges(const DirectedEdges& edges, std::size_t pointCount);

/// The same, one after the other.
std::vector<std::uint32_t> groupEdges(const DirectedEdges& edges, std::size_t pointCount);

/// Calls visit(begin, end) for each run of equal edges in `order`.
template <typename Visit>
void forEachGroup(const DirectedEdges& edges, const std::vector<std::uint32_t>& order,
                  const Visit& visit) {
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin + 1;
        while (end < order.size() && edges.low(order[end]) == edges.low(order[begin]) &&
               edges.high(order[end]) == edges.high(order[begin])) {
            ++end;
        }
        visit(begin, end);
        begin = end;
    }
}

/// Calls visit(block, group) for each run of equal edges in `lists`, in parallel for blocks of
/// points: `block` says which, and is below indexBlocks(points).
template <typename Visit>
void forEachGroupInBlocks(const DirectedEdges& edges, const PointLists& lists, const Visit& visit) {
    forEachIndexBlock(lists.start.size() - 1, [&](std::size_t firstPoint, std::size_t endPoint) {
        for (std::size_t p = firstPoint; p < endPoint; ++p) {
            const std::span<const std::uint32_t> list = lists.of(p);
            for (std::size_t begin = 0; begin < list.size();) {
                const std::uint32_t high = edges.high(list[begin]);
                std::size_t end = begin + 1;
                while (end < list.size() && edges.high(list[end]) == high) ++end;
                visit(firstPoint / kIndexBlock, list.subspan(begin, end - begin));
                begin = end;
            }
        }
    });
}

}  // namespace bandvox
