#pragma once

#include "render/ray_march.h"

#include <bandvox/core/progress.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/render/picture_options.h>

#include <openvdb/openvdb.h>

#include <memory>
#include <optional>

namespace bandvox {

/// A grid as something whose surface can be drawn: larger inside than outside.
struct DrawableGrid {
    openvdb::FloatGrid::ConstPtr grid;        ///< of a level set a copy with opposite signs
    std::optional<DensityMetadata> metadata;  ///< of a density of this library
    double iso = 0;                           ///< above the grid's background
    bool isLevelSet = false;
};

/// `iso`: as asked for, if it was. Throws Error(ErrorKind::Input) for a grid that cannot be drawn,
/// or whose stored iso-value is not above its background; Error(ErrorKind::Usage) for an iso-value
/// asked for that is not.
DrawableGrid makeDrawable(const openvdb::FloatGrid::ConstPtr& grid,
                          const std::optional<double>& iso);

/// How a grid is read between its nodes, and how far a line of sight may step.
struct SurfaceField {
    std::unique_ptr<Reconstruction> reconstruction;
    double slope;          ///< of a flat face, per voxel
    ClearDistance clear;   ///< outside
    ClearDistance inside;  ///< the same inside
};

/// What was band-limited by this library is read by the filter that it was made with, other grids
/// by the cubic spline through their values. `maximum`: of the lattice, all of which is finite.
/// Throws Error(ErrorKind::Input) if the filter leaves too much to be read,
/// Error(ErrorKind::Interrupted) if the caller wants to stop.
SurfaceField readSurface(const DrawableGrid& drawable, double maximum,
                         const PictureOptions& options,
                         const Progress& progress = silentProgress());

/// Bytes for a reconstruction's bricks: what most pictures need, if the machine has it.
std::size_t cacheBytes(const PictureOptions& options);

/// A lattice as a continuous field: by the filter that its metadata name, or else by the cubic
/// spline. `mostlyRead` is as for makeBrickReconstruction. Throws Error(ErrorKind::Input) if the
/// filter leaves too much to be read.
std::unique_ptr<Reconstruction> readLattice(
    const openvdb::FloatGrid::ConstPtr& grid, const std::optional<DensityMetadata>& metadata,
    const PictureOptions& options, const std::optional<DensityBand>& mostlyRead = std::nullopt);

/// The lattice value beyond which the surface may be near: between the nodes the field can rise
/// above them.
double surfaceThreshold(const DrawableGrid& drawable);

}  // namespace bandvox
