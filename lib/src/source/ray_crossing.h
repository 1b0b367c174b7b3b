#pragma once

#include <openvdb/Types.h>

#include <array>
#include <optional>

namespace bandvox {

/// How often the ray from p towards +x leaves through the triangle: 1, 0, or -1 for entering.
///
/// The point stands for the place (y + ε, z + ε²) next to it, in the limit of small ε, and the side
/// of an edge is computed alike for both triangles that share it; so a ray that meets an edge or a
/// corner still crosses a closed surface exactly once.
int rayCrossing(const openvdb::Vec3d& p, const std::array<openvdb::Vec3d, 3>& corner);

/// Where a line along x crosses a triangle, and which way.
struct LineCrossing {
    double x;     ///< within the triangle's reach
    int leaving;  ///< 1, or -1 for entering
};

/// Where the line along x at (y, z) crosses the triangle, if it does, by the rules of rayCrossing.
std::optional<LineCrossing> lineCrossing(double y, double z,
                                         const std::array<openvdb::Vec3d, 3>& corner);

}  // namespace bandvox
