#pragma once

#include <bandvox/source/array_source.h>

#include <openvdb/math/Transform.h>

namespace bandvox {

/// The lattice of an array's voxels. Throws Error(ErrorKind::Input) if they are smaller than
/// OpenVDB's transforms take.
openvdb::math::Transform::Ptr latticeOf(const ArrayInfo& info);

}  // namespace bandvox
