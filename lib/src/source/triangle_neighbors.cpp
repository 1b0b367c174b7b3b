#include "source/triangle_neighbors.h"

#include "source/index_blocks.h"
#include "source/no_index.h"

#include <atomic>
#include <numeric>
#include <span>
#include <utility>

namespace bandvox {
namespace {

/// Sets of triangles that threads may join at the same time; the lowest of a set stands for it in
/// the end, whatever the order. S. V. Jayanti, R. E. Tarjan: "A Randomized Concurrent Algorithm for
/// Disjoint Set Union" (2016), with the triangles' own order for the random one.
class SharedSets {
  public:
    explicit SharedSets(std::size_t count) : mParents(count) {
        std::iota(mParents.begin(), mParents.end(), 0U);
    }

    void join(std::uint32_t a, std::uint32_t b) {
        while (true) {
            a = find(a);
            b = find(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            std::uint32_t expected = a;
            if (parent(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
        }
    }

    /// Numbers the sets. Not while another thread joins any.
    ConnectedTriangles number() && {
        // What stands for a triangle, or for that, is before it and has its number.
        ConnectedTriangles sets;
        for (std::size_t i = 0; i < mParents.size(); ++i) {
            mParents[i] =
                mParents[i] == i ? static_cast<std::uint32_t>(sets.count++) : mParents[mParents[i]];
        }
        sets.setOf = std::move(mParents);
        return sets;
    }

  private:
    std::atomic_ref<std::uint32_t> parent(std::uint32_t i) {
        return std::atomic_ref<std::uint32_t>(mParents[i]);
    }

    std::uint32_t find(std::uint32_t i) {
        while (true) {
            std::uint32_t above = parent(i).load(std::memory_order_relaxed);
            if (above == i) return i;
            const std::uint32_t higher = parent(above).load(std::memory_order_relaxed);
            if (higher == above) return above;
            parent(i).compare_exchange_weak(above, higher, std::memory_order_relaxed);
            i = higher;
        }
    }

    std::vector<std::uint32_t> mParents;
};

}  // namespace

TriangleNeighbors findNeighbors(const DirectedEdges& edges, const PointLists& lists) {
    TriangleNeighbors neighbors;
    neighbors.mate.assign(edges.count(), kNoIndex);
    std::atomic<std::size_t> crowded = 0;
    std::atomic<bool> agree = true;
    forEachGroupInBlocks(edges, lists, [&](std::size_t, std::span<const std::uint32_t> group) {
        if (group.size() > 2) ++crowded;
        if (group.size() != 2) return;
        neighbors.mate[group[0]] = group[1];
        neighbors.mate[group[1]] = group[0];
        if (edges.rises(group[0]) == edges.rises(group[1])) agree = false;
    });
    neighbors.crowdedEdges = crowded;
    neighbors.agree = agree;
    return neighbors;
}

ConnectedTriangles connectNeighbors(const TriangleNeighbors& neighbors) {
    const std::vector<std::uint32_t>& mate = neighbors.mate;
    SharedSets sets(mate.size() / 3);
    forEachIndex(mate.size() / 3, [&](std::size_t i) {
        const auto triangle = static_cast<std::uint32_t>(i);
        for (std::size_t e = 3 * i; e < 3 * i + 3; ++e) {
            if (mate[e] != kNoIndex && mate[e] / 3 < triangle) sets.join(triangle, mate[e] / 3);
        }
    });
    return std::move(sets).number();
}

}  // namespace bandvox
