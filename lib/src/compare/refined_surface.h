#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/mesh/surface_mesh.h>
#include <bandvox/reconstruct/reconstruction.h>

#include <openvdb/openvdb.h>

namespace bandvox {

/// The surface {f = iso} of a field on a lattice, inside where f is larger.
struct IsoSurface {
    const Reconstruction& field;
    const openvdb::math::Transform& transform;
    double iso;
};

/// Cuts each triangle into four, and brings the new points onto the surface. Throws
/// Error(ErrorKind::Memory).
SurfaceMesh cutTriangles(const SurfaceMesh& coarse, const IsoSurface& surface, Progress& progress);

/// The largest distance of the middle of a triangle from the surface, world units.
double measureDeviation(const Mesh& mesh, const IsoSurface& surface, Progress& progress);

}  // namespace bandvox
