#pragma once

#include <openvdb/openvdb.h>

#include <string>

namespace bandvox {

/// What is wrong with where the active voxels of a grid are, as "has ...; expected ..."; empty if
/// nothing is. Those beyond ±2^30 leave no room for halos and coarser neighbours, whose indices
/// would overflow.
std::string extentFault(const openvdb::GridBase& grid);

}  // namespace bandvox
