#pragma once

#include "source/box_tree.h"

#include <bandvox/source/mesh.h>

#include <openvdb/Types.h>

#include <cstdint>
#include <optional>

namespace bandvox {

/// The point of a mesh that is nearest to a place.
struct NearestPoint {
    openvdb::Vec3d place;
    std::uint32_t triangle = 0;
    double squaredDistance = 0;
};

/// Finds the points of a mesh that are nearest to places, by a tree of the triangles' boxes. May be
/// read by many threads.
class NearestTriangle {
  public:
    explicit NearestTriangle(Mesh mesh);

    const Mesh& mesh() const { return mMesh; }

    /// The nearest point, if it is no farther than `distance`. `guess`: a triangle that is near,
    /// which saves time; any if it is not known.
    std::optional<NearestPoint> find(const openvdb::Vec3d& place, double distance,
                                     std::optional<std::uint32_t> guess = {}) const;

  private:
    openvdb::Vec3d nearestOn(std::uint32_t triangle, const openvdb::Vec3d& place) const;

    Mesh mMesh;
    BoxTree mTree;
};

}  // namespace bandvox
