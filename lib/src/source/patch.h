#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <memory>
#include <vector>

namespace bandvox {

/// A rectangle of a patch's parameters, within [0, 1]².
struct ParameterCell {
    double u0 = 0, u1 = 1;
    double v0 = 0, v1 = 1;
};

/// A point of a patch and the derivatives by its parameters, world units.
struct PatchPoint {
    openvdb::Vec3d position;
    openvdb::Vec3d du, dv;
};

/// A smooth piece of a surface, S(u, v) for (u, v) in [0, 1]²; ∂S/∂u × ∂S/∂v points outward.
class Patch {
  public:
    virtual ~Patch() = default;

    virtual PatchPoint at(double u, double v) const = 0;

    /// A box that holds S(cell) up to rounding, world units.
    virtual openvdb::BBoxd bounds(const ParameterCell& cell) const = 0;
};

using PatchList = std::vector<std::unique_ptr<const Patch>>;

/// A plane quadrilateral, bilinear in its parameters.
class QuadPatch final : public Patch {
  public:
    /// Corners in a plane, counter-clockwise from outside.
    QuadPatch(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
              const openvdb::Vec3d& d)
        : mOrigin(a), mU(b - a), mV(d - a), mTwist(c - b - d + a) {}

    double area() const { return 0.5 * (mU + mV + mTwist).cross(mV - mU).length(); }

    PatchPoint at(double u, double v) const override {
        return {mOrigin + u * mU + v * mV + (u * v) * mTwist, mU + v * mTwist, mV + u * mTwist};
    }
    openvdb::BBoxd bounds(const ParameterCell& cell) const override;

  private:
    openvdb::Vec3d mOrigin, mU, mV, mTwist;
};

}  // namespace bandvox
