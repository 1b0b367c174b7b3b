#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>

namespace bandvox {

/// True if all voxels of a leaf are active and have one value, as those of a tile.
inline bool isConstantLeaf(const openvdb::FloatTree::LeafNodeType& leaf) {
    const float* values = leaf.buffer().data();
    const float first = values[0];
    return leaf.isDense() &&
           std::all_of(values, values + leaf.SIZE, [first](float v) { return v == first; });
}

}  // namespace bandvox
