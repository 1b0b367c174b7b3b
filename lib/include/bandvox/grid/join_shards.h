#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/core/shard.h>

#include <openvdb/openvdb.h>

#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// What a grid that is a part of a larger one says of itself, stored as grid metadata named
/// bandvox_shard ("2/4"), bandvox_shard_overlaps and bandvox_shard_refinements.
struct ShardMetadata {
    Shard shard;
    bool overlaps = false;  ///< shells of the surface overlap here, so all has to be limited
    int refinements = 0;    ///< how often the quadrature had to be made finer
};

void setShardMetadata(openvdb::GridBase& grid, const ShardMetadata& metadata);

/// What `grid` says of itself, or nothing if it is a whole.
std::optional<ShardMetadata> shardMetadata(const openvdb::GridBase& grid);

/// Removes the part from the settings that a grid stores, bandvox_settings: of a grid that one
/// machine has made whole beside its part of another.
void forgetPart(openvdb::GridBase& grid);

/// A grid joined of its parts.
struct JoinedGrid {
    openvdb::GridBase::Ptr grid;
    std::vector<std::string> warnings;  ///< in words, for the user
};

/// Joins the parts of a grid of floats or of vectors of floats to what a machine alone would have
/// made, voxel for voxel and tile for tile. The parts, in any order, share no voxel; they are used
/// up. Their metadata become those of the whole: errors are the largest, the integral is taken
/// anew, and where shells overlap in any part the density is limited to [0, 1].
///
/// Throws Error(ErrorKind::Input), which names what is missing, there twice, or different, unless
/// they are all parts of one grid; `names` are what errors call them, as many. Throws
/// Error(ErrorKind::Interrupted), and then the parts are lost.
JoinedGrid joinShards(const std::vector<openvdb::GridBase::Ptr>& parts,
                      const std::vector<std::string>& names, Progress& progress = silentProgress());

}  // namespace bandvox
