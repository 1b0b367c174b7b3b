#pragma once

#include "outline/drawing/curve.h"

#include <openvdb/Types.h>

#include <optional>

namespace bandvox {

/// A place of a volume, and two functions there, f and g, that both vanish on a curve. In index
/// coordinates.
struct SpacePoint {
    openvdb::Vec3d at{0, 0, 0};
    double f = 0, g = 0;
    openvdb::Vec3d df{0, 0, 0}, dg{0, 0, 0};  ///< their gradients
    double turn = 1;  ///< has another sign beyond a place where the curve's image turns back

    /// Along the curve, of length 1; 0 where the gradients are parallel.
    openvdb::Vec3d tangent() const;
};

/// A curve in a volume, for one thread at a time.
class CurveEquations {
  public:
    virtual ~CurveEquations() = default;

    virtual SpacePoint at(const openvdb::Vec3d& index) = 0;

    /// g alone.
    virtual double side(const openvdb::Vec3d& index) = 0;

    /// A point of the curve as the page sees it.
    virtual CurvePoint seen(const SpacePoint& point) const = 0;

    /// Whether a place of the curve belongs to it: beyond one that does not it ends.
    virtual bool holds(const SpacePoint& /*point*/) { return true; }
};

/// The place of a curve that is nearest, about, to one not farther away than `reach` voxels, by
/// Newton's method; nothing if there is none.
std::optional<SpacePoint> ontoCurve(CurveEquations& equations, const openvdb::Vec3d& near,
                                    double reach);

/// The place between two that follow each other, at a share of the way.
std::optional<SpacePoint> spaceBetween(CurveEquations& equations, const openvdb::Vec3d& a,
                                       const openvdb::Vec3d& b, double share);

}  // namespace bandvox
