#pragma once

#include <openvdb/openvdb.h>

#include <vector>

namespace bandvox {

/// The sum of a leaf's active values.
double sumOfActive(const openvdb::FloatTree::LeafNodeType& leaf);

/// densityIntegral of a grid, of whose leaf nodes the sums are known, in the tree's order.
double integralOf(const openvdb::FloatGrid& grid, const std::vector<double>& sums);

}  // namespace bandvox
