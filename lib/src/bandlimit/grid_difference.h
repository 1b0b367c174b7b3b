#pragma once

#include <openvdb/openvdb.h>

namespace bandvox {

/// The largest difference of two grids' values at the same index, active or not.
double largestDifference(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b);

}  // namespace bandvox
