#pragma once

#include <openvdb/math/Transform.h>

#include <string>

namespace bandvox {

/// What is wrong with a transform that a file says a grid has, as "has ...; expected ..."; empty if
/// nothing is. Linear ones have to be finite, with voxels of three directions whose sides are up to
/// 1e30 world units and whose volume is at least 3e-15, below which OpenVDB's own maps refuse it;
/// what a file says of sides and inverses beside them has to agree.
std::string transformFault(const openvdb::math::Transform& transform);

}  // namespace bandvox
