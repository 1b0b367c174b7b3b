#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/tile_plan.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>

#include <string>
#include <vector>

// What both routes to a density do in the same way.
namespace bandvox {

/// Throws Error(ErrorKind::Usage) for options out of range.
void requireValid(const DensityOptions& options);

/// Side of a voxel, world units, for the source of that name with these bounds. Throws
/// Error(ErrorKind::Input), or Error(ErrorKind::Usage) if the options give it, if it is smaller
/// than OpenVDB's transforms take.
double chooseVoxelSize(const std::string& source, const openvdb::BBoxd& bounds,
                       const DensityOptions& options);

/// Bytes that a grid with so many leaf nodes takes while it is made. A little high, by
/// measurements on meshes between 128³ and 1024³.
double memoryOfGrid(double leaves);

/// Bytes that are kept for the columns of tiles.
double memoryOfColumns(const TileLayout& layout);

/// Warns if the filter leaves more than the tolerance at the lattice's highest frequency.
void warnOfFilter(const ExponentialFilter& filter, double tolerance,
                  std::vector<std::string>& warnings);

/// Completes the metadata of the result's grid, of which source, route, errors, source volume and
/// clamped are set already. `integral`: of the grid, as densityIntegral has it. Throws
/// Error(ErrorKind::Result) if the grid is empty.
void describeGrid(const DensityOptions& options, const TileGeometry& geometry, double integral,
                  DensityResult& result);

/// Joins the columns to the result's grid and completes its metadata, of which source, route,
/// errors, source volume and clamped are set already. Throws Error(ErrorKind::Result) if the grid
/// would be empty.
void finishGrid(std::vector<ColumnBlocks>& columns, const TileLayout& layout,
                const DensityOptions& options, const TileGeometry& geometry, DensityResult& result,
                Progress& progress);

}  // namespace bandvox
