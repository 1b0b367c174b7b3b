#pragma once

#include "source/patch.h"

#include <memory>

namespace bandvox {

/// A point of a profile and its derivative by the parameter: distance from the axis, and height.
struct ProfilePoint {
    double r, y;
    double dr, dy;
};

/// The range of a profile over an interval of its parameter.
struct ProfileRange {
    double rMin, rMax;
    double yMin, yMax;
};

/// A curve in the half plane r ≥ 0, by a parameter in [0, 1]. Seen with r to the right and y up,
/// the solid lies to its left.
class Profile {
  public:
    virtual ~Profile() = default;
    virtual ProfilePoint at(double u) const = 0;
    virtual ProfileRange range(double u0, double u1) const = 0;
};

/// A straight line: turns into a disc, a cone or a cylinder.
class LineProfile final : public Profile {
  public:
    LineProfile(double r0, double y0, double r1, double y1)
        : mR(r0), mY(y0), mDr(r1 - r0), mDy(y1 - y0) {}
    ProfilePoint at(double u) const override { return {mR + u * mDr, mY + u * mDy, mDr, mDy}; }
    ProfileRange range(double u0, double u1) const override;

  private:
    double mR, mY, mDr, mDy;
};

/// An arc of a circle about (r, y): turns into a part of a sphere or a torus. Angles in radians,
/// from the direction of r towards y.
class ArcProfile final : public Profile {
  public:
    ArcProfile(double r, double y, double radius, double angle0, double angle1)
        : mR(r), mY(y), mRadius(radius), mAngle0(angle0), mAngle1(angle1) {}
    ProfilePoint at(double u) const override;
    ProfileRange range(double u0, double u1) const override;

  private:
    double mR, mY, mRadius, mAngle0, mAngle1;
};

/// The hyperbola r² = waist² + slope²·y² for y0 ≤ y ≤ y1: turns into a hyperboloid of one sheet.
class HyperbolaProfile final : public Profile {
  public:
    HyperbolaProfile(double waist, double slope, double y0, double y1)
        : mWaist(waist), mSlope(slope), mY0(y0), mY1(y1) {}
    ProfilePoint at(double u) const override;
    ProfileRange range(double u0, double u1) const override;

  private:
    double mWaist, mSlope, mY0, mY1;
};

/// A sector of a surface of revolution about a line parallel to y.
class RevolutionPatch final : public Patch {
  public:
    /// The axis passes through `center`, from which the profile's heights count as well.
    RevolutionPatch(std::shared_ptr<const Profile> profile, const openvdb::Vec3d& center,
                    double angle0, double angle1)
        : mProfile(std::move(profile)), mCenter(center), mAngle0(angle0), mAngle1(angle1) {}

    PatchPoint at(double u, double v) const override;
    openvdb::BBoxd bounds(const ParameterCell& cell) const override;

  private:
    std::shared_ptr<const Profile> mProfile;
    openvdb::Vec3d mCenter;
    double mAngle0, mAngle1;
};

/// Appends the whole surface of revolution, as four sectors.
void appendRevolution(const std::shared_ptr<const Profile>& profile, const openvdb::Vec3d& center,
                      PatchList& patches);

}  // namespace bandvox
