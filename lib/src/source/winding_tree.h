#pragma once

#include "source/winding_moments.h"
#include "source/winding_terms.h"

#include <bandvox/source/mesh.h>

#include <openvdb/math/BBox.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace bandvox {

/// A place and how far from it others may be, world units.
struct WindingRegion {
    openvdb::Vec3d center;
    double radius = 0;
};

/// The triangles of a mesh in a tree of balls, each with the moments of what it holds.
/// docs/any-mesh.md tells how it is used.
class WindingTree {
  public:
    /// Throws Error(ErrorKind::Memory) before allocating if it would not fit.
    explicit WindingTree(Mesh mesh);

    /// Makes `terms` those that the winding number at all places of a region is the sum of. Groups
    /// are taken together that are `farAway` of their radii away: 3.5 make errors of less than
    /// 1e-3, 2 of less than 1e-2 (docs/any-mesh.md).
    void collect(const WindingRegion& region, double farAway, WindingTerms& terms) const;

    /// A bound on the winding number's gradient in a region, per world unit, apart from its jumps
    /// at triangles. Once it is sure to be above `enough`, any number above that.
    double gradientBound(const WindingRegion& region, double enough) const;

    /// False only if no triangle has a point in the box, its faces included.
    bool mayMeet(const openvdb::BBoxd& box) const;

    /// Calls visit(t) for each triangle whose ball meets that of the region.
    template <typename Visit>
    void visitNear(const WindingRegion& region, const Visit& visit) const;

    std::size_t triangleCount() const { return mTriangles.size(); }
    /// Triangles are numbered in the tree's order.
    std::array<openvdb::Vec3d, 3> corners(std::uint32_t triangle) const {
        const openvdb::Vec3I& t = mTriangles[triangle];
        return {mPoints[t[0]], mPoints[t[1]], mPoints[t[2]]};
    }

  private:
    struct Node {
        openvdb::Vec3d center;  // of area
        double radius = 0;      // of a ball about it that holds the triangles
        double area = 0;        // their areas' sum
        double openLength = 0;  // of edges that no other triangle has the opposite of
        std::uint32_t begin = 0, end = 0;
        std::uint32_t right = 0;  // second child; the first follows its parent; 0 in a leaf
        WindingMoments moments;
    };
    // Two bounds on the gradient: by the open edges of the whole surface, and by its area.
    struct GradientBounds {
        double byEdges = 0, byArea = 0;
    };

    std::vector<std::uint8_t> findOpenEdges() const;
    void sortTriangles();
    void build(std::uint32_t begin, std::uint32_t end, const std::vector<std::uint8_t>& open,
               std::vector<Node>& nodes) const;
    void fillLeaf(const std::vector<std::uint8_t>& open, Node& node) const;
    void fillFromChildren(const Node& left, const Node& right, Node& node) const;
    void boundByTriangles(const Node& node, const WindingRegion& region,
                          GradientBounds& bounds) const;

    template <typename Visit>
    void descend(const Visit& visit) const;

    std::vector<openvdb::Vec3d> mPoints;
    std::vector<openvdb::Vec3I> mTriangles;
    std::vector<std::uint8_t> mOpenEdges;  // of each triangle, a bit for each edge
    std::vector<Node> mNodes;
    // What a node looks like from afar, with its radius as the unit of length.
    std::vector<WindingMoments::Coefficients> mCoefficients;
};

// Calls visit(node) for the root, and for the children of each node for which it returns true.
template <typename Visit>
void WindingTree::descend(const Visit& visit) const {
    if (mNodes.empty()) return;
    constexpr int kDeepest = 128;
    std::array<std::uint32_t, kDeepest> pending;
    int count = 0;
    pending[count++] = 0;
    while (count > 0) {
        const std::uint32_t i = pending[--count];
        if (!visit(i) || mNodes[i].right == 0) continue;
        pending[count++] = mNodes[i].right;
        pending[count++] = i + 1;
    }
}

template <typename Visit>
void WindingTree::visitNear(const WindingRegion& region, const Visit& visit) const {
    descend([&](std::uint32_t i) {
        const Node& node = mNodes[i];
        const double reach = node.radius + region.radius;
        if ((node.center - region.center).lengthSqr() > reach * reach) return false;
        if (node.right == 0) {
            for (std::uint32_t t = node.begin; t < node.end; ++t) visit(t);
        }
        return true;
    });
}

}  // namespace bandvox
