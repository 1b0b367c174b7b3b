#pragma once

#include "outline/volumes/volume_equations.h"

namespace bandvox {

/// Suggestive contours of a volume's surface: where it would turn away from an eye a little aside.
/// There the curvature κ along w, the part of the direction to the eye within the tangent plane, is
/// 0 and grows towards the eye. Only where the surface faces the eye, and not nearly from the
/// front. D. DeCarlo, A. Finkelstein, S. Rusinkiewicz and A. Santella, "Suggestive contours for
/// conveying shape", 2003.
class SuggestiveEquations final : public CurveEquations {
  public:
    /// `surface` is kept by reference. `strength`: of the derivative of κ by the way along w, times
    /// the square of half of the volume's diagonal; less does not count.
    SuggestiveEquations(const VolumeSurface& surface, double strength);

    SpacePoint at(const openvdb::Vec3d& index) override;
    double side(const openvdb::Vec3d& index) override;
    CurvePoint seen(const SpacePoint& point) const override;
    bool holds(const SpacePoint& point) override;

  private:
    struct Frame;
    Frame frameAt(const openvdb::Vec3d& index, const DensityExpansion& density) const;

    const VolumeSurface& mSurface;
    std::unique_ptr<DensityProbe> mProbe;
    openvdb::Mat3d mToWorld, mToIndex;  // of directions, as rows
    double mLeast;                      // of κ's derivative, world
};

}  // namespace bandvox
