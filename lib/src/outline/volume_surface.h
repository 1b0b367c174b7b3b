#pragma once

#include "outline/space_curve.h"
#include "outline/volume_view.h"
#include "render/surface_object.h"

#include <memory>

namespace bandvox {

/// The surface of a volume, as the page sees it.
struct VolumeSurface {
    const SurfaceObject* object = nullptr;  ///< not empty
    VolumeView view;
    int index = 0;                     ///< of the volumes of the scene
    openvdb::Vec3d middle{0, 0, 0};    ///< of what is active, index coordinates
    double size = 0;                   ///< of that, from corner to corner, voxels
};

/// The contour {f~ = d, ∇f~·v = 0}, v along the line of sight: where that touches the surface. Its
/// image turns back where v lies along the curve itself, so that v·H v = 0, H being the Hessian;
/// where that is above 0 the line of sight lies inside of the solid around the place.
class ContourEquations final : public CurveEquations {
  public:
    /// `surface` is kept by reference.
    explicit ContourEquations(const VolumeSurface& surface);

    SpacePoint at(const openvdb::Vec3d& index) override;
    CurvePoint seen(const SpacePoint& point) const override;

  private:
    const VolumeSurface& mSurface;
    std::unique_ptr<DensityProbe> mProbe;
};

}  // namespace bandvox
