#pragma once

#include <bandvox/compare/compare_surfaces.h>
#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// How the surface of a grid is made for comparing it.
struct GridToSurfaceOptions {
    std::optional<double> iso;  ///< as MeshOptions::iso
    int cuts = 1;               ///< how often each triangle is cut into four, 0 to 3
};

/// The surface of a grid, to be compared.
struct SurfaceOfGrid {
    ComparedSurface surface;  ///< with the field's normals; `deviation` was measured
    double iso = 0;           ///< the value that is the surface
    double volume = 0;        ///< inside the mesh that densityToMesh made, world units³
    double voxel = 0;         ///< shortest side of a voxel, world units
};

/// The surface {f~ = iso} as the mesh of densityToMesh, each triangle cut into four once or more,
/// with the new points brought onto the surface along the gradient. The deviation is the largest
/// distance |f~ - iso| / |∇f~| of the middle of a triangle from the surface, to first order; a
/// smooth surface is farther from its triangles nowhere else. Triangles whose points could not be
/// brought there, as at kinks of foreign fields, count by where they are.
///
/// The same for any number of threads. Throws as densityToMesh, and Error(ErrorKind::Usage) for
/// options out of range.
SurfaceOfGrid gridToSurface(const openvdb::FloatGrid::ConstPtr& grid,
                            const GridToSurfaceOptions& options = {},
                            Progress& progress = silentProgress());

}  // namespace bandvox
