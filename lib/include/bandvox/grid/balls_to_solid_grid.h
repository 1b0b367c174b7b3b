#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <span>

namespace bandvox {

/// Balls, for whoever holds them; as many radii as centers.
struct Balls {
    std::span<const openvdb::Vec3d> centers;  ///< world units
    std::span<const double> radii;            ///< world units, 0 or more

    /// The box that holds all of them.
    openvdb::BBoxd bounds() const;
};

/// A union of balls on a lattice, and what of it the lattice does not hold.
struct BallGrid {
    openvdb::FloatGrid::Ptr grid;  ///< a level set: below 0 inside
    std::size_t tooSmall = 0;      ///< balls left out, since their radius is below 1.5 voxels of it
    double lostVolume = 0;         ///< of those, world units³, each counted for itself
};

/// The union of balls as distances from its surface, for makeGridSurface, on a lattice that suits
/// a density of voxels of side `voxelSize` (world units, above 0): half of that side, or a fourth
/// or an eighth where balls are that small and it takes less than 2 GB. Its voxel 0 lies in their
/// midst. Balls whose radius is below 1.5 voxels of the lattice are left out, and counted.
///
/// The surface of marching cubes cuts corners; balls are enlarged by h²/(5 r), h the lattice's
/// voxel, so that each encloses its volume (docs/points.md). By OpenVDB's ParticlesToLevelSet and,
/// for balls of more voxels than that can hold, LevelSetSphere.
///
/// Throws Error(ErrorKind::Usage) for a voxel size that is not above 0, or other numbers of radii
/// than of centers, Error(ErrorKind::Result) if no ball is large enough, Error(ErrorKind::Input) if
/// they lie too far from the origin for voxels of that size, Error(ErrorKind::Memory),
/// Error(ErrorKind::Interrupted).
BallGrid ballsToSolidGrid(const Balls& balls, double voxelSize,
                          Progress& progress = silentProgress());

}  // namespace bandvox
