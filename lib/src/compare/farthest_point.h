#pragma once

#include "mesh/triangle_tree.h"

#include <bandvox/core/progress.h>

#include <cstddef>
#include <vector>

namespace bandvox {

/// How far a place on one mesh is from another, and the triangle that is the nearest.
struct PlaceDistance {
    openvdb::Vec3d place{0, 0, 0};
    double distance = 0;
    std::uint32_t triangle = 0;
};

PlaceDistance placeDistance(const TriangleTree& other, const openvdb::Vec3d& place,
                            std::uint32_t hint);

/// The point of a mesh that is farthest from another.
struct FarthestPoint {
    double distance = 0;  ///< found
    double atMost = 0;    ///< proven
    PlaceDistance at;
};

/// How thoroughly it is looked for.
struct FarthestSearch {
    double tolerance;        ///< world units
    std::size_t mostPieces;  ///< into which triangles may be cut
};

/// Branch and bound. `corners` are the mesh's points, `middles` the middles of its triangles.
FarthestPoint findFarthest(const Mesh& mesh, const TriangleTree& other,
                           const std::vector<PlaceDistance>& corners,
                           const std::vector<PlaceDistance>& middles, const FarthestSearch& search,
                           Progress& progress);

}  // namespace bandvox
