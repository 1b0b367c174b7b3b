#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox {

inline double distanceToSegment(const openvdb::Vec3d& p, const openvdb::Vec3d& a,
                                const openvdb::Vec3d& b) {
    const openvdb::Vec3d along = b - a;
    const double square = along.lengthSqr();
    const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
    return (p - (a + t * along)).length();
}

inline double distanceToTriangle(const openvdb::Vec3d& p,
                                 const std::array<openvdb::Vec3d, 3>& corner) {
    // The nearest point lies in the plane if that is within all three edges, else on an edge.
    const openvdb::Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double square = normal.lengthSqr();
    bool isWithin = square > 0;
    for (int k = 0; k < 3 && isWithin; ++k) {
        isWithin = normal.cross(corner[(k + 1) % 3] - corner[k]).dot(p - corner[k]) >= 0;
    }
    if (isWithin) return std::abs(normal.dot(p - corner[0])) / std::sqrt(square);
    return std::min({distanceToSegment(p, corner[0], corner[1]),
                     distanceToSegment(p, corner[1], corner[2]),
                     distanceToSegment(p, corner[2], corner[0])});
}

}  // namespace bandvox
