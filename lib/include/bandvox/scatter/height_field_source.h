#pragma once

#include <bandvox/scatter/bspline_surface.h>
#include <bandvox/source/boundary_source.h>

#include <memory>
#include <string>

namespace bandvox {

/// The solid under a height field: between the surface and the plane z = base, over the surface's
/// rectangle. Its boundary is the surface's Bézier patches, without tessellation, walls of the same
/// kind, and the bottom. Throws Error(ErrorKind::Usage) if the surface is not above the base
/// everywhere.
std::unique_ptr<BoundarySource> makeHeightFieldSource(const std::string& name,
                                                      const BsplineSurface& surface, double base,
                                                      int column = 0);

/// A height below all of the surface's Bézier ordinates, by `margin` times their range, or by
/// `margin` times the rectangle's shorter side if they are all the same.
double heightBelow(const BsplineSurface& surface, double margin, int column = 0);

}  // namespace bandvox
