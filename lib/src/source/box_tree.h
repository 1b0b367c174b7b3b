#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// A bounding volume hierarchy: finds the boxes of a list that a line parallel to x meets, that
/// hold a point, or that meet a box.
class BoxTree {
  public:
    explicit BoxTree(std::vector<openvdb::BBoxd> boxes);

    /// Calls visit(i) for each box i that the ray from `origin` towards +x meets or touches.
    template <typename Visit>
    void visitAlongX(const openvdb::Vec3d& origin, const Visit& visit) const {
        const auto meets = [&origin](const openvdb::BBoxd& box) {
            return box.max().x() >= origin.x() && box.min().y() <= origin.y() &&
                   box.max().y() >= origin.y() && box.min().z() <= origin.z() &&
                   box.max().z() >= origin.z();
        };
        visitWhere(meets, visit);
    }

    /// Calls visit(i) for each box i that holds the point.
    template <typename Visit>
    void visitAround(const openvdb::Vec3d& point, const Visit& visit) const {
        visitWhere([&point](const openvdb::BBoxd& box) { return box.isInside(point); }, visit);
    }

    /// Calls visit(i) for each box i that meets or touches a box.
    template <typename Visit>
    void visitMeeting(const openvdb::BBoxd& box, const Visit& visit) const {
        visitWhere([&box](const openvdb::BBoxd& other) { return other.hasOverlap(box); }, visit);
    }

  private:
    struct Node {
        openvdb::BBoxd box;
        std::uint32_t begin, end;  ///< its items
        std::uint32_t right = 0;   ///< second child; the first follows its parent; 0 in a leaf
    };

    template <typename Meets, typename Visit>
    void visitWhere(const Meets& meets, const Visit& visit) const {
        if (mBoxes.empty()) return;
        std::vector<std::uint32_t> pending = {0};
        while (!pending.empty()) {
            const Node& node = mNodes[pending.back()];
            const std::uint32_t left = pending.back() + 1;
            pending.pop_back();
            if (!meets(node.box)) continue;
            if (node.right != 0) {
                pending.push_back(node.right);
                pending.push_back(left);
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                if (meets(mBoxes[mItems[i]])) visit(mItems[i]);
            }
        }
    }

    void build(std::uint32_t begin, std::uint32_t end);

    std::vector<openvdb::BBoxd> mBoxes;
    std::vector<std::uint32_t> mItems;
    std::vector<Node> mNodes;
};

}  // namespace bandvox
