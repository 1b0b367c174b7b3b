#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace bandvox {

/// Points of a surface, for whoever holds them; as many normals as points.
struct OrientedPoints {
    std::span<const openvdb::Vec3d> points;   ///< world units
    std::span<const openvdb::Vec3f> normals;  ///< outward, of any length but 0
};

/// A solid on a lattice, and how it came about.
struct OrientedPointsGrid {
    openvdb::FloatGrid::Ptr grid;  ///< of the class of level sets: below 0 inside, 0 on the surface
    double spacing = 0;            ///< mean distance of a point from the six nearest, world units
    std::size_t withoutNormal = 0;      ///< points that were left out, as their normal is 0
    bool turned = false;                ///< the normals point inward
    double unsupported = 0;             ///< share of the surface that is far from all points
    bool cut = false;                   ///< the surface left the box around the points
    std::vector<std::string> warnings;  ///< of all this in words, for the user
};

/// The solid whose surface passes near points and is square to their normals: of an indicator
/// function, whose gradient fits the normals best, the surface that the median of its values at the
/// points tells (docs/points.md). That function is linear in the cells of a Delaunay triangulation
/// of the points and of what refines it.
///
/// It is read on a lattice of half the side of a density's voxel, `voxelSize` (world units, above
/// 0), or half the spacing of the points if that is less, from the points on along the surface.
/// What the surface encloses far from all points, as across a hole of a scan, is a guess. It is cut
/// off at a fourth of the box's diagonal from the box of the points.
///
/// M. Kazhdan, M. Bolitho, H. Hoppe: "Poisson Surface Reconstruction" (2006), as in CGAL's
/// Poisson_reconstruction_function. The same for any number of threads.
///
/// Throws Error(ErrorKind::Usage) for a voxel size that is not above 0, or other numbers of normals
/// than of points, Error(ErrorKind::Input) for fewer than 10 points with a normal, or points that
/// lie in a plane, Error(ErrorKind::Result) if no surface comes of them, Error(ErrorKind::Memory),
/// Error(ErrorKind::Interrupted).
OrientedPointsGrid orientedPointsToSolidGrid(const OrientedPoints& points, double voxelSize,
                                             Progress& progress = silentProgress());

}  // namespace bandvox
