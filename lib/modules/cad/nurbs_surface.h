#pragma once

#include "source/cad_shape.h"
#include "source/parameter_curve.h"

#include <Geom_BSplineSurface.hxx>
#include <Geom_Surface.hxx>
#include <array>
#include <vector>

namespace bandvox {

/// A rectangle of a surface's parameters as a B-spline surface, with the map of parameters: cones,
/// spheres and the like have angles for theirs, of which each coordinate goes to one of the
/// B-spline's.
class NurbsSurface {
  public:
    /// Throws Error(ErrorKind::Input) for degrees and weights that patches cannot have. May throw
    /// Standard_Failure.
    NurbsSurface(const Handle(Geom_Surface) & surface, const ParameterBox& box);

    const BsplineNet& net() const { return mNet; }

    /// Whether parameters are the same, but for their range.
    bool keepsParameters() const { return mKeeps; }

    /// The surface's parameters as parts of the B-spline's range, [0, 1]².
    std::array<double, 2> placeOf(const std::array<double, 2>& p) const;

    /// Where the map of coordinate `axis` is not smooth, in the surface's parameters.
    std::vector<double> breaks(std::size_t axis) const;

  private:
    std::array<double, 2> locate(const std::array<double, 2>& p, std::array<double, 2> guess) const;
    void fillNet();

    Handle(Geom_Surface) mSurface;
    Handle(Geom_BSplineSurface) mSpline;
    ParameterBox mBox;
    bool mKeeps = true;
    std::array<double, 2> mReference{}, mSplineReference{};
    std::array<std::array<double, 2>, 2> mRange{};  // of the B-spline
    BsplineNet mNet;
};

}  // namespace bandvox
