#pragma once

#include "voxelize/bit_column.h"
#include "voxelize/sub_samples.h"
#include "voxelize/voxel_lattice.h"

#include <openvdb/openvdb.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace bandvox {

using VoxelLeaf = openvdb::FloatTree::LeafNodeType;

/// The voxels of one column.
struct ColumnVoxels {
    std::vector<std::unique_ptr<VoxelLeaf>> leaves;  ///< those in part inside, x rising
    std::vector<SolidRun> solid;                     ///< x rising
    std::int64_t voxels = 0;                         ///< active
    std::int64_t eighths = 0;                        ///< sum of the values, times 8
    bool isClosed = true;                            ///< each row's winding number returns to 0
    bool isInsideOut = false;                        ///< a winding number is negative somewhere
};

/// Gives the bits of a column of samples, by its place: a block of the lattice of the samples.
using SampledColumns = std::function<BitColumn(const openvdb::Coord& block)>;

/// The lattice of what is sampled: the voxels' centres, or the sub-samples.
VoxelLattice sampleLattice(const VoxelLattice& lattice, const VoxelOptions& options);

/// Makes the voxels of the column at `block` from its samples: one column of them, or four.
ColumnVoxels makeColumn(const VoxelLattice& lattice, const VoxelOptions& options,
                        const openvdb::Coord& block, const SampledColumns& samples);

}  // namespace bandvox
