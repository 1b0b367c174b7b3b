#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/mesh/surface_mesh.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// How the surface of a density becomes triangles.
struct MeshOptions {
    /// The value that is the surface, above the grid's background; below it for level sets.
    /// Default: the one stored in the grid, else 0.5; 0 for level sets.
    std::optional<double> iso;

    /// How much of the points is left out where the surface hardly bends, 0 to 1: what is left
    /// stays within a quarter of a voxel times this of all that was there.
    double adaptivity = 0;

    double tolerance = 1e-3;  ///< distance of points from the surface, voxels, 1e-5 to 0.1
    openvdb::Vec3SGrid::ConstPtr colors;  ///< in linear light; default: none
};

/// A mesh, and how it came about.
struct MeshResult {
    SurfaceMesh surface;
    double iso = 0;                     ///< the value that is the surface
    double volume = 0;                  ///< inside of the mesh, world units³
    std::size_t cells = 0;              ///< that the surface passes
    std::size_t ambiguousFaces = 0;     ///< of cells, on which the reconstruction had to decide
    std::size_t pointsCollapsed = 0;    ///< left out by adaptivity
    std::vector<std::string> warnings;  ///< in words, for the user
};

/// The surface {f~ = iso} of what a grid stands for between its nodes (reconstruct): band-limited
/// densities by their own filter, other grids by the cubic spline. Each point is found on an edge
/// of the lattice whose ends lie on different sides; the triangles in a cell follow from its
/// corners, and from f~ in the middle of a face where those leave a choice. So the mesh is closed,
/// every edge has two triangles of opposite direction, and every point one fan of them
/// (docs/mesh-output.md). What rises and falls between two neighbouring nodes is not seen.
///
/// W. Lorensen, H. Cline: "Marching Cubes" (1987); the choice on faces after G. Nielson, B. Hamann:
/// "The Asymptotic Decider" (1991). The same for any number of threads.
/// Throws Error(ErrorKind::Result) if the surface is empty; Error(ErrorKind::Input) if the grid has
/// no active voxel, a value that is not finite or a transform that is not linear, or an iso-value
/// stored in it that its background exceeds; Error(ErrorKind::Usage) if `grid` is null or an option
/// is out of range; Error(ErrorKind::Memory) if the mesh would not fit.
MeshResult densityToMesh(const openvdb::FloatGrid::ConstPtr& grid, const MeshOptions& options = {},
                         Progress& progress = silentProgress());

}  // namespace bandvox
