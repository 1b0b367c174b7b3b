#include "outline/volume_surface.h"

#include <cmath>

namespace bandvox {

using openvdb::Vec3d;

ContourEquations::ContourEquations(const VolumeSurface& surface)
    : mSurface(surface), mProbe(surface.object->probe()) {}

SpacePoint ContourEquations::at(const Vec3d& index) {
    const DensityExpansion density = mProbe->expand(index);
    const Vec3d sight = mSurface.view.sight(index), bent = density.hessian * sight;
    SpacePoint point{.at = index};
    point.f = density.value - mSurface.object->threshold();
    point.g = density.gradient.dot(sight);
    point.df = density.gradient;
    point.dg = bent + mSurface.view.spread() * density.gradient;
    point.turn = sight.dot(bent);
    return point;
}

CurvePoint ContourEquations::seen(const SpacePoint& point) const {
    const Vec3d place = mSurface.view.place(point.at);
    CurvePoint result{.x = place[0], .y = place[1], .z = place[2]};
    // The tangent plane is seen as a line, which the curve's image follows, even where it stops.
    const Vec3d across = point.df.cross(mSurface.view.sight(point.at));
    const auto [x, y] = mSurface.view.move(point.at, across);
    const double length = std::hypot(x, y);
    if (length > 0) {
        result.tx = x / length;
        result.ty = y / length;
    }
    result.patch = mSurface.index;
    result.u = point.at[0];
    result.v = point.at[1];
    result.s = point.at[2];
    result.rule = CurveRule::Volume;
    return result;
}

}  // namespace bandvox
