#include "render/object_colors.h"

#include <bandvox/core/error.h>

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace bandvox {

using openvdb::Vec3d;

namespace {

constexpr float kBrightest = 1e6F;

}  // namespace

ObjectColors::ObjectColors(openvdb::Vec3SGrid::ConstPtr grid)
    : mGrid(std::move(grid)),
      mToIndex(mGrid->transform().baseMap()->getAffineMap()->getMat4().inverse()) {
    const std::string name = "the grid \"" + mGrid->getName() + "\" ";
    if (!mGrid->transform().isLinear()) {
        throw Error(ErrorKind::Input, name + "has a transform of type " +
                                          mGrid->transform().mapType() + "; expected a linear one");
    }
    for (auto color = mGrid->cbeginValueOn(); color; ++color) {
        for (int c = 0; c < 3; ++c) {
            if (std::abs((*color)[c]) <= kBrightest) continue;
            throw Error(ErrorKind::Input, name + "has a colour of " + std::to_string((*color)[c]) +
                                              "; expected colours up to " +
                                              std::to_string(kBrightest));
        }
    }
}

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
    sum /= weights;
    return Vec3d(std::max(sum[0], 0.0), std::max(sum[1], 0.0), std::max(sum[2], 0.0));
}

}  // namespace bandvox
