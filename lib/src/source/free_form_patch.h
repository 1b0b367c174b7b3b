#pragma once

#include "source/patch.h"

#include <bandvox/source/bezier_patch.h>

#include <vector>

namespace bandvox {

/// A Bézier patch, rational or not, as it is: no tessellation.
class FreeFormPatch final : public Patch {
  public:
    explicit FreeFormPatch(BezierPatch patch);

    PatchPoint at(double u, double v) const override;

    /// The box of the control points, and where that is smaller, that of the bilinear surface
    /// through the cell's corners widened by what second derivatives allow.
    openvdb::BBoxd bounds(const ParameterCell& cell) const override;

    const BezierPatch& patch() const { return mPatch; }

  private:
    using Homogeneous = std::array<double, 4>;
    Homogeneous homogeneousAt(double u, double v) const;

    BezierPatch mPatch;
    openvdb::BBoxd mHull;
    Homogeneous mBendU{}, mBendV{};  ///< the largest second derivatives of (w x, w y, w z, w)
    double mLeastWeight;
};

/// The box of patches to within `tolerance`, world units; it holds them.
openvdb::BBoxd tightBounds(const std::vector<FreeFormPatch>& patches, double tolerance);

/// Area, and flux of the position relative to a point: a third of it adds to the volume.
struct PatchIntegrals {
    double area = 0, flux = 0;
};

/// By Gauss rules on halves until they agree: to 1e-12 of area times `size` for the flux.
PatchIntegrals integrate(const Patch& patch, const openvdb::Vec3d& center, double size);

}  // namespace bandvox
