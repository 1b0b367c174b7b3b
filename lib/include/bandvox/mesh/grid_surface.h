#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/boundary_source.h>

#include <openvdb/math/Mat4.h>
#include <openvdb/openvdb.h>

#include <memory>
#include <optional>
#include <string>

namespace bandvox {

/// Which solid a grid stands for, and where.
struct GridSurfaceOptions {
    /// The value that is the surface, above the grid's background; below it for level sets.
    /// Default: the one stored in the grid, else 0.5; 0 for level sets.
    std::optional<double> iso;
    /// From the grid's world to the one of the source, acting on rows; may turn, shear and scale.
    openvdb::Mat4d toSource = openvdb::Mat4d::identity();
};

/// The solid of a grid that other programs made: where its values, linear along the edges of the
/// lattice, are above the iso-value, or below it for a level set. Its surface is that of marching
/// cubes, which cuts off 1/8 to 1/12 of a voxel for each radian that it turns in a voxel
/// (docs/solids-of-volumes.md). The triangles are never stored: each block of 8³ cells is an
/// element, and makes its own when it is asked for samples, so memory is that of the grid.
///
/// W. Lorensen, H. Cline: "Marching Cubes" (1987); the choice on faces by G. Nielson, B. Hamann:
/// "The Asymptotic Decider" (1991).
/// Throws Error(ErrorKind::Result) if the surface is empty; Error(ErrorKind::Input) if the grid has
/// no active voxel, a value that is not finite or a transform that is not linear, or an iso-value
/// stored in it that its background exceeds; Error(ErrorKind::Usage) if `grid` is null, or for an
/// iso-value asked for that is not above the background; Error(ErrorKind::Interrupted).
std::unique_ptr<BoundarySource> makeGridSurface(const std::string& name,
                                                const openvdb::FloatGrid::ConstPtr& grid,
                                                const GridSurfaceOptions& options = {},
                                                Progress& progress = silentProgress());

}  // namespace bandvox
