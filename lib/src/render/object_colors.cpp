#include "render/object_colors.h"

#include <openvdb/tree/ValueAccessor.h>

#include <cmath>
#include <utility>

namespace bandvox {

using openvdb::Vec3d;

ObjectColors::ObjectColors(openvdb::Vec3SGrid::ConstPtr grid)
    : mGrid(std::move(grid)),
      mToIndex(mGrid->transform().baseMap()->getAffineMap()->getMat4().inverse()) {}

std::optional<Vec3d> ObjectColors::at(const Vec3d& place) const {
    const Vec3d index = mToIndex.transform(place);
    const openvdb::Coord first = openvdb::Coord::floor(index);
    const Vec3d part = index - first.asVec3d();
    const openvdb::tree::ValueAccessor<const openvdb::Vec3STree, false> accessor(mGrid->tree());
    Vec3d sum(0.0);
    double weights = 0;
    openvdb::Vec3f color;
    for (int i = 0; i < 8; ++i) {
        const openvdb::Coord corner(i & 1, i >> 1 & 1, i >> 2);
        if (!accessor.probeValue(first + corner, color)) continue;
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            weight *= corner[axis] != 0 ? part[axis] : 1 - part[axis];
        }
        sum += weight * Vec3d(color);
        weights += weight;
    }
    if (!(weights > 0)) return std::nullopt;
    return sum / weights;
}

}  // namespace bandvox
