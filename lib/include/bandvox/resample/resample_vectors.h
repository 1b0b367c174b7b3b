#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/resample/resample_grid.h>

#include <openvdb/openvdb.h>

namespace bandvox {

/// Brings a grid of vectors, as colours or velocities, to another lattice: each component as by
/// resampleGrid, which throws. Vectors count where they are active alone, so that those at the rim
/// do not fade: the filtered components are divided by the filtered number of active voxels, and
/// voxels of which a tenth at least is filled are active. Components keep their directions, and the
/// grid its metadata.
openvdb::Vec3SGrid::Ptr resampleVectors(const openvdb::Vec3SGrid::ConstPtr& source,
                                        const openvdb::math::Transform& target,
                                        const ResampleOptions& options = {},
                                        Progress& progress = silentProgress());

}  // namespace bandvox
