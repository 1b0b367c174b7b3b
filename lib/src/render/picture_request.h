#pragma once

#include <bandvox/grid/density_grid.h>
#include <bandvox/render/density_to_image.h>

#include <openvdb/math/BBox.h>

#include <optional>

namespace bandvox {

/// Throws Error(ErrorKind::Usage) for options out of range.
void requireValid(const RenderOptions& options);

/// Throws Error(ErrorKind::Input) unless `grid` is a density that can be drawn.
void requireDensity(const openvdb::FloatGrid& grid);

/// The density that is the surface. Throws Error(ErrorKind::Usage) unless it is above the
/// background.
double isoOf(const openvdb::FloatGrid& grid, const std::optional<DensityMetadata>& metadata,
             const RenderOptions& options);

/// The box of the active voxels, world units.
openvdb::BBoxd worldBox(const openvdb::FloatGrid& grid);

/// Throws Error(ErrorKind::Result), for a grid whose values reach no more than `maximum`.
[[noreturn]] void failEmpty(double maximum, double iso);

/// Throws Error(ErrorKind::Result) if nothing was hit.
void requireHits(const RenderResult& result);

}  // namespace bandvox
