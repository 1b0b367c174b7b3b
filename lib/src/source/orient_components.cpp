#include "source/orient_components.h"

#include "source/directed_edges.h"
#include "source/no_index.h"
#include "source/triangle_neighbors.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace bandvox {
namespace {

/// Walks over the neighbours of triangles, and decides which to flip.
class Walk {
  public:
    Walk(const DirectedEdges& edges, const std::vector<std::uint32_t>& mate,
         MeshComponents& components, std::vector<char>& flipped)
        : mEdges(edges), mMate(mate), mComponents(components), mFlipped(flipped) {}

    /// Visits the piece of a triangle that has none yet.
    void visitComponent(std::uint32_t seed) {
        const auto component = static_cast<std::uint32_t>(mComponents.count++);
        mTriangles.assign(1, seed);
        mComponents.ofTriangle[seed] = component;
        std::size_t flips = 0;
        bool oneSided = false;
        for (std::size_t i = 0; i < mTriangles.size(); ++i) {
            const std::uint32_t t = mTriangles[i];
            for (std::uint32_t e = 3 * t; e < 3 * t + 3; ++e) {
                if (mMate[e] == kNoIndex) continue;
                // Neighbours agree if they run along their edge in opposite directions.
                const std::uint32_t other = mMate[e] / 3;
                const bool same = mEdges.rises(e) == mEdges.rises(mMate[e]);
                const bool flip = same != (mFlipped[t] != 0);
                if (mComponents.ofTriangle[other] == kNoIndex) {
                    mComponents.ofTriangle[other] = component;
                    mFlipped[other] = flip ? 1 : 0;
                    flips += flip ? 1 : 0;
                    mTriangles.push_back(other);
                } else if ((mFlipped[other] != 0) != flip) {
                    oneSided = true;
                }
            }
        }
        if (oneSided) mComponents.oneSided.push_back(component);

        // Keep the orientation that most triangles had.
        if (2 * flips > mTriangles.size()) {
            for (const std::uint32_t t : mTriangles) mFlipped[t] = mFlipped[t] != 0 ? 0 : 1;
            flips = mTriangles.size() - flips;
        }
        mComponents.trianglesFlipped += flips;
    }

  private:
    const DirectedEdges& mEdges;
    const std::vector<std::uint32_t>& mMate;
    MeshComponents& mComponents;
    std::vector<char>& mFlipped;
    std::vector<std::uint32_t> mTriangles;  ///< of the piece, in the order of their visit
};

/// Appends, for each piece, how often a group's edge is left over in one direction.
void appendBoundary(const DirectedEdges& edges, std::span<const std::uint32_t> group,
                    const std::vector<char>& flipped, const std::vector<std::uint32_t>& ofTriangle,
                    std::vector<BoundaryEdge>& boundary) {
    std::vector<std::pair<std::uint32_t, int>> turns;  // component; +1 from low to high end
    for (const std::uint32_t e : group) {
        const bool rises = edges.rises(e) != (flipped[e / 3] != 0);
        turns.emplace_back(ofTriangle[e / 3], rises ? 1 : -1);
    }
    std::sort(turns.begin(), turns.end());
    for (std::size_t i = 0; i < turns.size();) {
        const std::uint32_t component = turns[i].first;
        int net = 0;
        for (; i < turns.size() && turns[i].first == component; ++i) net += turns[i].second;
        const std::uint32_t low = edges.low(group.front());
        const std::uint32_t high = edges.high(group.front());
        for (; net > 0; --net) boundary.push_back({component, low, high});
        for (; net < 0; ++net) boundary.push_back({component, high, low});
    }
}

}  // namespace

MeshComponents orientComponents(Mesh& mesh, const PointLists& lists) {
    const DirectedEdges edges(mesh);
    MeshComponents components;
    std::vector<char> flipped(mesh.triangles.size(), 0);
    {
        const TriangleNeighbors neighbors = findNeighbors(edges, lists);
        components.nonManifoldEdges = neighbors.crowdedEdges;
        if (neighbors.agree) {
            // Then there is nothing to flip, and no need to walk.
            ConnectedTriangles connected = connectNeighbors(neighbors);
            components.ofTriangle = std::move(connected.setOf);
            components.count = connected.count;
        } else {
            components.ofTriangle.assign(mesh.triangles.size(), kNoIndex);
            Walk walk(edges, neighbors.mate, components, flipped);
            for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
                if (components.ofTriangle[t] == kNoIndex) walk.visitComponent(t);
            }
        }
    }

    // Collect what each piece leaves open.
    std::vector<std::vector<BoundaryEdge>> boundaries(indexBlocks(mesh.points.size()));
    forEachGroupInBlocks(
        edges, lists, [&](std::size_t block, std::span<const std::uint32_t> group) {
            const auto rises = [&](std::uint32_t e) {
                return edges.rises(e) != (flipped[e / 3] != 0);
            };
            if (group.size() == 2 && rises(group[0]) != rises(group[1])) return;
            appendBoundary(edges, group, flipped, components.ofTriangle, boundaries[block]);
        });
    for (const std::vector<BoundaryEdge>& part : boundaries) {
        components.boundary.insert(components.boundary.end(), part.begin(), part.end());
    }
    std::sort(components.boundary.begin(), components.boundary.end(),
              [](const BoundaryEdge& a, const BoundaryEdge& b) {
                  return std::tie(a.component, a.from, a.to) < std::tie(b.component, b.from, b.to);
              });

    if (components.trianglesFlipped == 0) return components;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (flipped[t] != 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    return components;
}

}  // namespace bandvox
