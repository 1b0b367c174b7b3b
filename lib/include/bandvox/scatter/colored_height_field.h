#pragma once

#include <bandvox/scatter/bspline_surface.h>
#include <bandvox/source/colored_mesh.h>

#include <array>
#include <string>

namespace bandvox {

/// A height field with the colours of three of the surface's other columns, as triangles between
/// samples: what a grid of colours is made of. Colours are linear light and limited to 0 to 1.
/// `red`: the first of the three columns. Throws Error(ErrorKind::Usage) if they are not there.
ColoredMesh coloredHeightField(const std::string& name, const BsplineSurface& surface,
                               std::array<int, 2> samples, int red, int column = 0);

}  // namespace bandvox
