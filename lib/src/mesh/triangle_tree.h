#pragma once

#include <bandvox/source/mesh.h>

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace bandvox {

using TriangleCorners = std::array<openvdb::Vec3d, 3>;

inline TriangleCorners cornersOf(const Mesh& mesh, std::size_t triangle) {
    const openvdb::Vec3I& t = mesh.triangles[triangle];
    return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
}

/// The point of a triangle that is nearest to a place.
struct NearestOnTriangle {
    openvdb::Vec3d point{0, 0, 0};
    openvdb::Vec3d weights{0, 0, 0};                          ///< of the corners, ≥ 0, sum 1
    double square = std::numeric_limits<double>::infinity();  ///< of the distance
};

/// Triangles without area are segments or points.
NearestOnTriangle nearestOnTriangle(const openvdb::Vec3d& place, const TriangleCorners& corners);

/// The point of a mesh that is nearest to a place.
struct NearestOnMesh : NearestOnTriangle {
    std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();
};

/// Finds nearest points of a mesh: a bounding volume hierarchy. Safe to use from many threads. The
/// mesh must outlive it, and has a triangle at least.
class TriangleTree {
  public:
    /// Throws Error(ErrorKind::Memory) if it would not fit.
    explicit TriangleTree(const Mesh& mesh);

    /// The nearest point; of several triangles that are as near, always the same. `hint`: a
    /// triangle that may be near, for speed.
    NearestOnMesh nearest(const openvdb::Vec3d& place, std::uint32_t hint) const;

    /// The same if it is no farther than `distance`. Without a hint the search takes longer.
    std::optional<NearestOnMesh> nearestWithin(const openvdb::Vec3d& place, double distance,
                                               std::optional<std::uint32_t> hint = {}) const;

    const Mesh& mesh() const { return mMesh; }

  private:
    struct Node {
        openvdb::BBoxd box;
        std::uint32_t begin, end;  // its triangles, in mOrder
        std::uint32_t right = 0;   // second child; the first follows its parent; 0 in a leaf
    };

    void build(std::uint32_t begin, std::uint32_t end);
    void look(const openvdb::Vec3d& place, std::uint32_t triangle, NearestOnMesh& found) const;
    void search(const openvdb::Vec3d& place, NearestOnMesh& found) const;

    const Mesh& mMesh;
    std::vector<std::uint32_t> mOrder;
    std::vector<Node> mNodes;
};

}  // namespace bandvox
