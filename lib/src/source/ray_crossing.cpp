#include "source/ray_crossing.h"

#include <algorithm>
#include <utility>

namespace bandvox {

using openvdb::Vec3d;

namespace {

// How often the triangle, seen along x, goes around the point.
int turnsAround(double y, double z, const std::array<Vec3d, 3>& corner) {
    int winding = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3d* lower = &corner[i];
        const Vec3d* upper = &corner[(i + 1) % 3];
        if ((lower->y() <= y) == (upper->y() <= y)) continue;
        const bool rises = lower->y() <= y;
        if (!rises) std::swap(lower, upper);
        const double side = (upper->y() - lower->y()) * (z - lower->z()) -
                            (upper->z() - lower->z()) * (y - lower->y());
        // A point on the edge stands for the place (y + ε, z + ε²) next to it.
        const bool isAbove = side > 0.0 || (side == 0.0 && upper->z() <= lower->z());
        if (isAbove) winding += rises ? 1 : -1;
    }
    return winding;
}

}  // namespace

int rayCrossing(const Vec3d& p, const std::array<Vec3d, 3>& corner) {
    const int winding = turnsAround(p.y(), p.z(), corner);
    if (winding == 0) return 0;

    // Compare the depth of the triangle's plane with that of the point.
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double height = normal.dot(corner[0] - p);
    const bool ahead = normal.x() != 0.0
                           ? height / normal.x() > 0.0
                           : corner[0].x() + corner[1].x() + corner[2].x() > 3.0 * p.x();
    return ahead ? winding : 0;
}

std::optional<LineCrossing> lineCrossing(double y, double z, const std::array<Vec3d, 3>& corner) {
    const int winding = turnsAround(y, z, corner);
    if (winding == 0) return std::nullopt;
    const auto [least, most] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const Vec3d from(0.0, y - corner[0].y(), z - corner[0].z());
    const double x =
        normal.x() != 0.0 ? corner[0].x() - normal.dot(from) / normal.x() : 0.5 * (least + most);
    return LineCrossing{std::clamp(x, least, most), winding};
}

}  // namespace bandvox
