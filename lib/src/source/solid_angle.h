#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cmath>

namespace bandvox {

/// The solid angle that a triangle takes up, seen from p, positive from behind; 0 in its plane.
/// A. van Oosterom, J. Strackee: "The Solid Angle of a Plane Triangle" (1983), eq. 8.
inline double solidAngle(const openvdb::Vec3d& p, const std::array<openvdb::Vec3d, 3>& corner) {
    const openvdb::Vec3d a = corner[0] - p, b = corner[1] - p, c = corner[2] - p;
    const double la = a.length(), lb = b.length(), lc = c.length();
    const double determinant = a.dot(b.cross(c));
    if (determinant == 0) return 0;
    return 2 *
           std::atan2(determinant, la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace bandvox
