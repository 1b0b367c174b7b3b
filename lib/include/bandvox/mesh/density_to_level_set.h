#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <optional>

namespace bandvox {

/// How distances from a surface are computed.
struct LevelSetOptions {
    /// The value that is the surface, above the grid's background; below it for level sets.
    /// Default: the one stored in the grid, else 0.5; 0 for level sets.
    std::optional<double> iso;
    double halfWidth = 3;  ///< of the band around the surface in which they are, voxels; 1 to 100
    double tolerance = 1e-3;  ///< error allowed, voxels; 1e-5 to 0.1
};

/// A level set, and what was found while it was made.
struct LevelSetResult {
    openvdb::FloatGrid::Ptr grid;  ///< named "surface", of the class of level sets
    double iso = 0;                ///< the value that is the surface
    double volume = 0;             ///< inside of the surface's mesh, world units³
    double largestCorrection = 0;  ///< of a distance to the mesh, voxels
};

/// The signed distance, world units and negative inside, from the surface {f~ = iso} of what a grid
/// stands for between its nodes (reconstruct), on the grid's own lattice, in a narrow band.
///
/// A voxel starts from the nearest point of the surface's mesh (densityToMesh), which goes to the
/// foot of the perpendicular on f~ itself by Newton's method: onto the surface along the gradient,
/// then along the tangent plane. Where that does not settle, as at the centre of a ball, the
/// distance from the mesh stays, which is off by 1/8 of the square of a cell's side times the
/// curvature. The sign is that of the voxel's own value.
///
/// Throws what densityToMesh does, and Error(ErrorKind::Input) unless voxels are cubes.
LevelSetResult densityToLevelSet(const openvdb::FloatGrid::ConstPtr& grid,
                                 const LevelSetOptions& options = {},
                                 Progress& progress = silentProgress());

/// A level set as OpenVDB's tools make fog of it (sdfToFogVolume): 1 deep inside, falling to 0 on
/// the surface itself over `halfWidth` voxels, so it is smaller than a density, whose value on the
/// surface is 0.5. Named "density". The level set is used up.
openvdb::FloatGrid::Ptr levelSetToFog(const openvdb::FloatGrid::Ptr& levelSet);

}  // namespace bandvox
