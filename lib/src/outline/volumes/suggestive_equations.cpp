#include "outline/volumes/suggestive_equations.h"

#include <cmath>

namespace bandvox {

using openvdb::Mat3d;
using openvdb::Vec3d;

namespace {

// Seen from nearer to the front than this a surface has valleys, but no contour to suggest.
constexpr double kLeastSine = 0.34;  // 20 degrees

Mat3d directionsToWorld(const VolumeSurface& surface) {
    return surface.object->grid().transform().baseMap()->getAffineMap()->getMat4().getMat3();
}

}  // namespace

/// A place of the surface and how it is seen; world units.
struct SuggestiveEquations::Frame {
    Vec3d w{0, 0, 0};   // to the eye, within the tangent plane; its length is the angle's sine
    double facing = 0;  // cosine of the angle between the normal and the direction to the eye
    double bend = 0;    // κ times the square of w's length
};

SuggestiveEquations::SuggestiveEquations(const VolumeSurface& surface, double strength)
    : mSurface(surface),
      mProbe(surface.object->probe()),
      mToWorld(directionsToWorld(surface)),
      mToIndex(mToWorld.inverse()) {
    const openvdb::CoordBBox box = surface.object->grid().evalActiveVoxelBoundingBox();
    const double half = 0.5 * (box.extents().asVec3d() * mToWorld).length();
    mLeast = strength / (half * half);
}

SuggestiveEquations::Frame SuggestiveEquations::frameAt(const Vec3d& index,
                                                        const DensityExpansion& density) const {
    Frame frame;
    const Vec3d gradient = mToIndex * density.gradient;
    const double slope = gradient.length();
    if (!(slope > 0)) return frame;
    // Out of the solid the normal is -∇f~ / |∇f~|.
    const Vec3d normal = -gradient / slope;
    const Vec3d eye = -(mSurface.view.sight(index) * mToWorld).unit();
    frame.facing = normal.dot(eye);
    frame.w = eye - frame.facing * normal;
    const Vec3d along = frame.w * mToIndex;
    frame.bend = -along.dot(density.hessian * along) / slope;
    return frame;
}

SpacePoint SuggestiveEquations::at(const Vec3d& index) {
    const DensityExpansion density = mProbe->expand(index);
    SpacePoint point{.at = index};
    point.f = density.value - mSurface.object->threshold();
    point.df = density.gradient;
    point.g = frameAt(index, density).bend;
    // Third derivatives of the density, as differences.
    constexpr double kStep = 0.1;  // voxels
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d low = index, high = index;
        low[axis] -= kStep;
        high[axis] += kStep;
        point.dg[axis] = (side(high) - side(low)) / (2 * kStep);
    }
    return point;
}

double SuggestiveEquations::side(const Vec3d& index) {
    return frameAt(index, mProbe->expand(index)).bend;
}

CurvePoint SuggestiveEquations::seen(const SpacePoint& point) const {
    return seenAlong(mSurface, point.at, point.tangent(), CurveRule::Suggestive);
}

bool SuggestiveEquations::holds(const SpacePoint& point) {
    const Frame frame = frameAt(point.at, mProbe->expand(point.at));
    const double sine = frame.w.length();
    if (!(frame.facing > 0) || !(sine > kLeastSine)) return false;
    // Where κ is 0 so is what it is multiplied with to be the bend.
    const double growth = point.dg.dot(frame.w * mToIndex) / (sine * sine * sine);
    return growth > mLeast;
}

}  // namespace bandvox
