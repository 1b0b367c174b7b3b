#pragma once

#include <bandvox/source/boundary_source.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/source/quadrature.h>

#include <vector>

namespace bandvox {

/// A quadrature point of a coloured surface.
struct ColoredSample {
    openvdb::Vec3f position;  ///< voxels, from the origin of the region it was asked for
    float area;               ///< voxels²
    openvdb::Vec3f color;     ///< linear light
};

/// Appends the quadrature points of triangle i that lie in the region (those on its far faces
/// excluded), dense enough for `quadrature` and for the triangle's texture; none if it has no
/// colour. A point depends on the triangle, the voxel size and `quadrature` alone.
///
/// A texture is taken from the level whose texels are about as far apart as the points, if the
/// finest has nearer ones: what lies between points must not be seen by some and not by others.
void sampleColors(const ColoredMesh& mesh, std::size_t i, const SamplingRegion& region,
                  const SurfaceQuadrature& quadrature, std::vector<ColoredSample>& samples);

}  // namespace bandvox
