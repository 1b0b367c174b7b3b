#pragma once

#include <bandvox/mesh/surface_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace bandvox {

/// What the parts of a mesh that are worked on at the same time have in common; each changes its
/// own entries only.
struct CollapsingMesh {
    SurfaceMesh& surface;
    std::vector<float> error;           ///< of each triangle, world units; < 0: it is gone
    std::vector<std::uint32_t> degree;  ///< triangles of each point
    std::vector<std::uint32_t> local;   ///< number of each point within its region
};

/// Collapses points of one region of a mesh: those all of whose triangles are among those given,
/// onto others of which that holds.
class CollapseRegion {
  public:
    CollapseRegion(CollapsingMesh& mesh, std::span<const std::uint32_t> triangles,
                   double tolerance);

    /// Returns how many points were left out.
    std::size_t collapse();

  private:
    struct Candidate {
        double cost;
        std::uint32_t point;   // its number in the region
        std::uint32_t change;  // of the point, when the cost was found
        bool operator<(const Candidate& other) const {
            return std::pair(cost, point) > std::pair(other.cost, other.point);
        }
    };

    // All points are numbered within the region.
    const openvdb::Vec3d& place(std::uint32_t point) const;
    std::uint32_t corner(std::uint32_t triangle, int k) const;
    bool isFree(std::uint32_t point) const;
    void findNeighbours(std::uint32_t point, std::vector<std::uint32_t>& found) const;
    float lookAround(std::uint32_t point);
    double moveCost(std::uint32_t point, std::uint32_t onto) const;
    void propose(std::uint32_t point);
    bool tryCollapse(std::uint32_t point);
    bool keepsManifold(std::uint32_t point, std::uint32_t onto);
    bool keepsShape(std::uint32_t point, std::uint32_t onto);
    double displacement(std::uint32_t point, std::uint32_t onto, double limit);
    void apply(std::uint32_t point, std::uint32_t onto, float error);

    CollapsingMesh& mMesh;
    double mTolerance;
    std::vector<std::uint32_t> mPoints;                  // of the mesh
    std::vector<std::vector<std::uint32_t>> mTriangles;  // of each point
    std::vector<openvdb::Vec3d> mNormals;                // of triangles around one point
    std::vector<std::uint32_t> mChanges;
    std::vector<bool> mIsFree;
    std::priority_queue<Candidate> mQueue;
    std::vector<std::uint32_t> mAround, mBeyond;            // neighbours of a point, and of another
    std::vector<std::array<openvdb::Vec3d, 3>> mOld, mNew;  // triangles around a point
};

}  // namespace bandvox
