#pragma once

#include "bandlimit/block_store.h"
#include "bandlimit/far_tiles.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace bandvox {

struct AssemblyOptions {
    double threshold;     ///< values nearer to a whole number than this are stored as it
    bool clamp;           ///< limit values to [0, 1]
    bool isPart = false;  ///< there are columns that others fill; of blocks that go on in them
                          ///< what is here is kept
};

using LeafList = std::vector<std::unique_ptr<DensityLeaf>>;

/// Calls body(begin, end), in parallel, for parts of `count` leaf nodes.
void forEachChunkOfLeaves(std::size_t count,
                          const std::function<void(std::size_t, std::size_t)>& body);

/// Limits values to [0, 1].
void limitValues(DensityLeaf& leaf);

/// Makes voxels active whose value is not 0. Returns false if none is.
bool activateNonzero(DensityLeaf& leaf);

/// Makes values next to a whole number that number, voxel by voxel, so that where the blocks lie
/// does not show; sets which voxels are active. Returns false if none is.
bool finishLeaf(DensityLeaf& leaf, const AssemblyOptions& options);

/// The same of each; those without an active voxel become null.
void finishLeaves(LeafList& leaves, const AssemblyOptions& options);

/// What pieces that were added up came to.
struct JoinedBlocks {
    LeafList leaves;  ///< finished; null where there is none
    std::vector<ConstantBlock> constant;
};

/// Adds up the pieces that columns have made of blocks that go on in others, and finishes the
/// blocks. All pieces of a block have to be there.
JoinedBlocks joinPieces(LeafList leaves, const FarTiles& far, const AssemblyOptions& options);

}  // namespace bandvox
