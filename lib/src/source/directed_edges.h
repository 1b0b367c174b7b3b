#pragma once

#include <bandvox/source/mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// Directed edges: number 3·t + k runs from corner k of triangle t to the next.
class DirectedEdges {
  public:
    explicit DirectedEdges(const Mesh& mesh) : mMesh(mesh) {}

    std::size_t count() const { return 3 * mMesh.triangles.size(); }
    std::uint32_t from(std::uint32_t e) const { return mMesh.triangles[e / 3][e % 3]; }
    std::uint32_t to(std::uint32_t e) const { return mMesh.triangles[e / 3][(e + 1) % 3]; }
    std::uint32_t low(std::uint32_t e) const { return std::min(from(e), to(e)); }
    std::uint32_t high(std::uint32_t e) const { return std::max(from(e), to(e)); }
    bool rises(std::uint32_t e) const { return from(e) < to(e); }

  private:
    const Mesh& mMesh;
};

/// All directed edges, those of equal ends side by side.
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

}  // namespace bandvox
