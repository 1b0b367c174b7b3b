#pragma once

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/progress.h>
#include <bandvox/mesh/surface_mesh.h>
#include <bandvox/render/image.h>
#include <bandvox/scatter/bspline_surface.h>
#include <bandvox/scatter/surface_quantity.h>

#include <array>
#include <vector>

namespace bandvox {

/// Writes a column of a surface as bicubic Bézier patches, which are the surface exactly: .bpt, in
/// text; the number of patches, and for each its degrees and 4 x 4 points. The caller commits it.
/// Throws Error(ErrorKind::Runtime) if it cannot be written.
void writeBezierPatches(AtomicFile& file, const BsplineSurface& surface, int column = 0,
                        Progress& progress = silentProgress());

/// Writes samples of all columns on a grid as a NumPy array of doubles, [x][y][number]: for each
/// column the quantities in the order that is given, three numbers for a normal.
void writeSamples(AtomicFile& file, const BsplineSurface& surface, std::array<int, 2> samples,
                  const std::vector<SurfaceQuantity>& quantities = {SurfaceQuantity::Value},
                  Progress& progress = silentProgress());

/// The height field of a column as two triangles to each cell of a grid of samples, with the
/// spline's normals. `red`: the first of three columns that are colours, linear light, or -1.
SurfaceMesh heightFieldMesh(const BsplineSurface& surface, std::array<int, 2> samples,
                            int column = 0, int red = -1,
                            const Progress& progress = silentProgress());

/// The same as a picture seen from above, x to the right and y up: depth is the height, and normals
/// and positions are the surface's. `quantities` of the column are channels of their names.
Image heightFieldImage(const BsplineSurface& surface, std::array<int, 2> samples, int column = 0,
                       int red = -1, const std::vector<SurfaceQuantity>& quantities = {},
                       const Progress& progress = silentProgress());

}  // namespace bandvox
