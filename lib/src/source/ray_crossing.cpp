#include "source/ray_crossing.h"

#include <utility>

namespace bandvox {

using openvdb::Vec3d;

int rayCrossing(const Vec3d& p, const std::array<Vec3d, 3>& corner) {
    int winding = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3d* lower = &corner[i];
        const Vec3d* upper = &corner[(i + 1) % 3];
        if ((lower->y() <= p.y()) == (upper->y() <= p.y())) continue;
        const bool rises = lower->y() <= p.y();
        if (!rises) std::swap(lower, upper);
        const double side = (upper->y() - lower->y()) * (p.z() - lower->z()) -
                            (upper->z() - lower->z()) * (p.y() - lower->y());
        if (side > 0.0) winding += rises ? 1 : -1;
    }
    if (winding == 0) return 0;

    // Compare the depth of the triangle's plane with that of the point.
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double height = normal.dot(corner[0] - p);
    const bool ahead = normal.x() != 0.0
                           ? height / normal.x() > 0.0
                           : corner[0].x() + corner[1].x() + corner[2].x() > 3.0 * p.x();
    return ahead ? winding : 0;
}

}  // namespace bandvox
