#pragma once

#include "placed_field.h"

#include <bandvox/render/camera.h>

#include <openvdb/Types.h>

#include <memory>
#include <optional>

namespace paper_figures {

/// The point of a surface that is nearest to a place.
struct NearestPoint {
    double distance;        ///< world units, ≥ 0
    openvdb::Vec3d normal;  ///< of the surface there, outward, of length 1
    double edgeDistance;    ///< from there to the nearest sharp edge; infinite if there is none
};

/// A surface by its formula: what the pictures are measured against.
class TrueSurface {
  public:
    virtual ~TrueSurface() = default;

    /// Where several points are nearest, as to a place outside of an edge, one of them.
    virtual NearestPoint nearest(const openvdb::Vec3d& place) const = 0;
};

using SurfacePtr = std::shared_ptr<const TrueSurface>;

/// The surfaces of the library's "shape:sphere" and "shape:cube".
SurfacePtr sphereSurface();
SurfacePtr cubeSurface();

/// Radii of a hyperboloid of one sheet about the y axis, -1 ≤ y ≤ 1; 0 < waist < rim.
struct HyperboloidRadii {
    double waist, rim;
    double at(double y) const;
};
SurfacePtr hyperboloidSurface(const HyperboloidRadii& radii);

/// A surface, placed.
SurfacePtr placedSurface(SurfacePtr surface, const Placement& placement);

/// Where a line of sight meets the surface, as a distance from the origin, which is outside; none
/// if not before `farthest`. To 1e-9.
std::optional<double> firstHit(const TrueSurface& surface, const bandvox::Ray& ray,
                               double farthest);

}  // namespace paper_figures
