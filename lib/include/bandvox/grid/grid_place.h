#pragma once

#include <openvdb/openvdb.h>

#include <string>

namespace bandvox {

/// What keeps two grids from lying in one world, in words: known spaces or units that are not the
/// same, as "the first has axes left-posterior-superior, the other right-anterior-superior". Empty
/// if nothing does.
std::string placeDifference(const openvdb::GridBase& first, const openvdb::GridBase& other);

/// Brings a grid to another space of scans, "LPS", "RAS" or "LAS": its transform, not its values.
/// Throws Error(ErrorKind::Usage) if the grid does not say that it is in one; of a grid of vectors
/// that are no colours, whose values would have to turn with it; and unless its transform is
/// linear.
void turnToSpace(openvdb::GridBase& grid, const std::string& space);

}  // namespace bandvox
