#pragma once

#include "outline/volumes/space_curve.h"
#include "outline/volumes/volume_view.h"
#include "render/surface_object.h"

#include <memory>

namespace bandvox {

/// The surface of a volume, as the page sees it.
struct VolumeSurface {
    const SurfaceObject* object = nullptr;  ///< not empty
    VolumeView view;
    int index = 0;                   ///< of the volumes of the scene
    openvdb::Vec3d middle{0, 0, 0};  ///< of what is active, index coordinates
    double size = 0;                 ///< of that, from corner to corner, voxels
};

/// A place of a curve that goes along a direction, both in index coordinates, as the page sees it.
CurvePoint seenAlong(const VolumeSurface& surface, const openvdb::Vec3d& index,
                     const openvdb::Vec3d& along, CurveRule rule);

/// The contour {f~ = d, ∇f~·v = 0}, v along the line of sight: where that touches the surface. Its
/// image turns back where v lies along the curve itself, so that v·H v = 0, H being the Hessian;
/// where that is above 0 the line of sight lies inside of the solid around the place.
class ContourEquations final : public CurveEquations {
  public:
    /// `surface` is kept by reference.
    explicit ContourEquations(const VolumeSurface& surface);

    SpacePoint at(const openvdb::Vec3d& index) override;
    double side(const openvdb::Vec3d& index) override;
    CurvePoint seen(const SpacePoint& point) const override;

  private:
    const VolumeSurface& mSurface;
    std::unique_ptr<DensityProbe> mProbe;
};

/// Where the surfaces of two volumes pass through each other; in index coordinates of the first.
class MeetingEquations final : public CurveEquations {
  public:
    /// Both are kept by reference.
    MeetingEquations(const VolumeSurface& surface, const VolumeSurface& other);

    SpacePoint at(const openvdb::Vec3d& index) override;
    double side(const openvdb::Vec3d& index) override;
    CurvePoint seen(const SpacePoint& point) const override;

  private:
    const VolumeSurface &mSurface, &mOther;
    std::unique_ptr<DensityProbe> mProbe, mOtherProbe;
    openvdb::Mat4d mToOther;  // from index to index coordinates
};

/// Where the normal of a volume's surface and the direction to a light are at one angle.
class IsophoteEquations final : public CurveEquations {
  public:
    /// `light`: world, length 1; `cosine` of the angle, -1 to 1. The surface is kept by reference.
    IsophoteEquations(const VolumeSurface& surface, const openvdb::Vec3d& light, double cosine);

    SpacePoint at(const openvdb::Vec3d& index) override;
    double side(const openvdb::Vec3d& index) override;
    CurvePoint seen(const SpacePoint& point) const override;

  private:
    const VolumeSurface& mSurface;
    std::unique_ptr<DensityProbe> mProbe;
    openvdb::Vec3d mLight;
    double mCosine;
    openvdb::Mat3d mToWorld;  // of gradients
};

}  // namespace bandvox
