#include "outline/volumes/volume_equations.h"

#include <cmath>

namespace bandvox {

using openvdb::Vec3d;

namespace {

openvdb::Mat4d toWorld(const VolumeSurface& surface) {
    return surface.object->grid().transform().baseMap()->getAffineMap()->getMat4();
}

}  // namespace

CurvePoint seenAlong(const VolumeSurface& surface, const Vec3d& index, const Vec3d& along,
                     CurveRule rule) {
    const Vec3d place = surface.view.place(index);
    CurvePoint result{.x = place[0], .y = place[1], .z = place[2]};
    const auto [x, y] = surface.view.move(index, along);
    const double length = std::hypot(x, y);
    if (length > 0) {
        result.tx = x / length;
        result.ty = y / length;
    }
    result.patch = surface.index;
    result.u = index[0];
    result.v = index[1];
    result.s = index[2];
    result.rule = rule;
    return result;
}

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

double ContourEquations::side(const Vec3d& index) {
    return mProbe->evaluate(index).gradient.dot(mSurface.view.sight(index));
}

CurvePoint ContourEquations::seen(const SpacePoint& point) const {
    // The tangent plane is seen as a line, which the curve's image follows, even where it stops.
    const Vec3d along = point.df.cross(mSurface.view.sight(point.at));
    return seenAlong(mSurface, point.at, along, CurveRule::VolumeFold);
}

MeetingEquations::MeetingEquations(const VolumeSurface& surface, const VolumeSurface& other)
    : mSurface(surface),
      mOther(other),
      mProbe(surface.object->probe()),
      mOtherProbe(other.object->probe()),
      mToOther(toWorld(surface) * toWorld(other).inverse()) {}

SpacePoint MeetingEquations::at(const Vec3d& index) {
    const DensityAt here = mProbe->evaluate(index);
    const DensityAt there = mOtherProbe->evaluate(mToOther.transform(index));
    SpacePoint point{.at = index};
    point.f = here.value - mSurface.object->threshold();
    point.g = there.value - mOther.object->threshold();
    point.df = here.gradient;
    point.dg = mToOther.getMat3() * there.gradient;
    return point;
}

double MeetingEquations::side(const Vec3d& index) {
    return mOtherProbe->value(mToOther.transform(index)) - mOther.object->threshold();
}

CurvePoint MeetingEquations::seen(const SpacePoint& point) const {
    CurvePoint result = seenAlong(mSurface, point.at, point.tangent(), CurveRule::VolumeMeeting);
    result.other = mOther.index;
    return result;
}

IsophoteEquations::IsophoteEquations(const VolumeSurface& surface, const Vec3d& light,
                                     double cosine)
    : mSurface(surface),
      mProbe(surface.object->probe()),
      mLight(light),
      mCosine(cosine),
      mToWorld(toWorld(surface).getMat3().inverse()) {}

SpacePoint IsophoteEquations::at(const Vec3d& index) {
    const DensityExpansion density = mProbe->expand(index);
    // Out of the solid the normal is -∇f~ / |∇f~|, in the world.
    const Vec3d gradient = mToWorld * density.gradient;
    const double slope = gradient.length();
    SpacePoint point{.at = index};
    point.f = density.value - mSurface.object->threshold();
    point.df = density.gradient;
    point.g = -gradient.dot(mLight) - mCosine * slope;
    const Vec3d by = -mLight - (slope > 0 ? mCosine / slope : 0) * gradient;
    point.dg = density.hessian * (mToWorld.transpose() * by);
    return point;
}

double IsophoteEquations::side(const Vec3d& index) {
    const Vec3d gradient = mToWorld * mProbe->evaluate(index).gradient;
    return -gradient.dot(mLight) - mCosine * gradient.length();
}

CurvePoint IsophoteEquations::seen(const SpacePoint& point) const {
    CurvePoint result = seenAlong(mSurface, point.at, point.tangent(), CurveRule::VolumeIsophote);
    result.t = mCosine;
    return result;
}

}  // namespace bandvox
