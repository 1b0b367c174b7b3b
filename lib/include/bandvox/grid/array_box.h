#pragma once

#include <openvdb/openvdb.h>

#include <optional>

namespace bandvox {

/// Stores in a grid the box of the array that it was made from, as bandvox_array_min and
/// bandvox_array_max, both included. What lies in it and is background is not stored otherwise, so
/// that nothing else would say how large the array was.
void setArrayBox(openvdb::GridBase& grid, const openvdb::CoordBBox& box);

/// Forgets that box: the grid has got another lattice.
void dropArrayBox(openvdb::GridBase& grid);

/// The box that a grid fills as an array: the stored one, unless there are active voxels outside of
/// it; else that of its active voxels, empty if there are none.
openvdb::CoordBBox arrayBox(const openvdb::GridBase& grid);

}  // namespace bandvox
