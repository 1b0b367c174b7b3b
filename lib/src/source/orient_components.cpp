#include "source/orient_components.h"

#include "source/directed_edges.h"
#include "source/no_index.h"

#include <algorithm>
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
void appendBoundary(const DirectedEdges& edges, const std::uint32_t* begin,
                    const std::uint32_t* end, const std::vector<char>& flipped,
                    MeshComponents& components) {
    std::vector<std::pair<std::uint32_t, int>> turns;  // component; +1 from low to high end
    for (const std::uint32_t* e = begin; e != end; ++e) {
        const bool rises = edges.rises(*e) != (flipped[*e / 3] != 0);
        turns.emplace_back(components.ofTriangle[*e / 3], rises ? 1 : -1);
    }
    std::sort(turns.begin(), turns.end());
    for (std::size_t i = 0; i < turns.size();) {
        const std::uint32_t component = turns[i].first;
        int net = 0;
        for (; i < turns.size() && turns[i].first == component; ++i) net += turns[i].second;
        const std::uint32_t low = edges.low(*begin);
        const std::uint32_t high = edges.high(*begin);
        for (; net > 0; --net) components.boundary.push_back({component, low, high});
        for (; net < 0; ++net) components.boundary.push_back({component, high, low});
    }
}

}  // namespace

MeshComponents orientComponents(Mesh& mesh) {
    const DirectedEdges edges(mesh);
    const std::vector<std::uint32_t> order = groupEdges(edges, mesh.points.size());

    MeshComponents components;
    components.ofTriangle.assign(mesh.triangles.size(), kNoIndex);

    // Find the neighbours across edges of exactly two triangles.
    std::vector<std::uint32_t> mate(edges.count(), kNoIndex);
    forEachGroup(edges, order, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 2) {
            mate[order[begin]] = order[begin + 1];
            mate[order[begin + 1]] = order[begin];
        } else if (end - begin > 2) {
            ++components.nonManifoldEdges;
        }
    });

    std::vector<char> flipped(mesh.triangles.size(), 0);
    Walk walk(edges, mate, components, flipped);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (components.ofTriangle[t] == kNoIndex) walk.visitComponent(t);
    }

    // Collect what each piece leaves open.
    forEachGroup(edges, order, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 2 &&
            (edges.rises(order[begin]) != (flipped[order[begin] / 3] != 0)) !=
                (edges.rises(order[begin + 1]) != (flipped[order[begin + 1] / 3] != 0))) {
            return;
        }
        appendBoundary(edges, order.data() + begin, order.data() + end, flipped, components);
    });
    std::sort(components.boundary.begin(), components.boundary.end(),
              [](const BoundaryEdge& a, const BoundaryEdge& b) {
                  return std::tie(a.component, a.from, a.to) < std::tie(b.component, b.from, b.to);
              });

    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (flipped[t] != 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    return components;
}

}  // namespace bandvox
