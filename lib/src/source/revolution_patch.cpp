#include "source/revolution_patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {
namespace {

using std::numbers::pi;

struct Interval {
    double min, max;
};

/// The range of the cosine between two angles, a ≤ b.
Interval cosineRange(double a, double b) {
    const auto passes = [a, b](double phase) {
        return std::ceil((a - phase) / (2.0 * pi)) <= (b - phase) / (2.0 * pi);
    };
    const auto [low, high] = std::minmax({std::cos(a), std::cos(b)});
    return {passes(pi) ? -1.0 : low, passes(0.0) ? 1.0 : high};
}

Interval sineRange(double a, double b) {
    return cosineRange(a - 0.5 * pi, b - 0.5 * pi);
}

/// The range of r·c for r ≥ 0.
Interval product(const ProfileRange& range, const Interval& c) {
    return {c.min * (c.min < 0.0 ? range.rMax : range.rMin),
            c.max * (c.max < 0.0 ? range.rMin : range.rMax)};
}

}  // namespace

ProfileRange LineProfile::range(double u0, double u1) const {
    const auto [rMin, rMax] = std::minmax({mR + u0 * mDr, mR + u1 * mDr});
    const auto [yMin, yMax] = std::minmax({mY + u0 * mDy, mY + u1 * mDy});
    return {rMin, rMax, yMin, yMax};
}

ProfilePoint ArcProfile::at(double u) const {
    const double turn = mAngle1 - mAngle0;
    const double c = mRadius * std::cos(mAngle0 + u * turn);
    const double s = mRadius * std::sin(mAngle0 + u * turn);
    return {mR + c, mY + s, -s * turn, c * turn};
}

ProfileRange ArcProfile::range(double u0, double u1) const {
    const double turn = mAngle1 - mAngle0;
    const Interval c = cosineRange(mAngle0 + u0 * turn, mAngle0 + u1 * turn);
    const Interval s = sineRange(mAngle0 + u0 * turn, mAngle0 + u1 * turn);
    return {std::max(0.0, mR + mRadius * c.min), mR + mRadius * c.max, mY + mRadius * s.min,
            mY + mRadius * s.max};
}

ProfilePoint HyperbolaProfile::at(double u) const {
    const double dy = mY1 - mY0;
    const double y = mY0 + u * dy;
    const double r = std::hypot(mWaist, mSlope * y);
    return {r, y, mSlope * mSlope * y / r * dy, dy};
}

ProfileRange HyperbolaProfile::range(double u0, double u1) const {
    const ProfilePoint p0 = at(u0);
    const ProfilePoint p1 = at(u1);
    const bool throughWaist = p0.y * p1.y <= 0.0;
    return {throughWaist ? mWaist : std::min(p0.r, p1.r), std::max(p0.r, p1.r), p0.y, p1.y};
}

PatchPoint RevolutionPatch::at(double u, double v) const {
    const ProfilePoint p = mProfile->at(u);
    const double turn = mAngle1 - mAngle0;
    const double c = std::cos(mAngle0 + v * turn);
    const double s = std::sin(mAngle0 + v * turn);
    return {mCenter + openvdb::Vec3d(p.r * c, p.y, p.r * s),
            openvdb::Vec3d(p.dr * c, p.dy, p.dr * s),
            openvdb::Vec3d(-p.r * s * turn, 0.0, p.r * c * turn)};
}

openvdb::BBoxd RevolutionPatch::bounds(const ParameterCell& cell) const {
    const ProfileRange range = mProfile->range(cell.u0, cell.u1);
    const double turn = mAngle1 - mAngle0;
    const double from = mAngle0 + cell.v0 * turn;
    const double to = mAngle0 + cell.v1 * turn;
    const Interval x = product(range, cosineRange(from, to));
    const Interval z = product(range, sineRange(from, to));
    return {mCenter + openvdb::Vec3d(x.min, range.yMin, z.min),
            mCenter + openvdb::Vec3d(x.max, range.yMax, z.max)};
}

void appendRevolution(const std::shared_ptr<const Profile>& profile, const openvdb::Vec3d& center,
                      PatchList& patches) {
    for (int quarter = 0; quarter < 4; ++quarter) {
        patches.push_back(std::make_unique<RevolutionPatch>(profile, center, 0.5 * pi * quarter,
                                                            0.5 * pi * (quarter + 1)));
    }
}

}  // namespace bandvox
