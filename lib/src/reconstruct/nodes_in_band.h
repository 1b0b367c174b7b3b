#pragma once

#include <bandvox/reconstruct/brick_reconstruction.h>

#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

namespace bandvox {

/// The smallest box of the nodes in `box` whose value lies in a band; empty if there are none.
openvdb::CoordBBox nodesInBand(
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& values,
    const openvdb::CoordBBox& box, const DensityBand& band);

}  // namespace bandvox
