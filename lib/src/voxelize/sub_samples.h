#pragma once

#include "voxelize/bit_column.h"

#include <array>
#include <cstdint>
#include <functional>

namespace bandvox {

constexpr int kSubSamples = 8;  ///< of a voxel, 2 along each axis

/// How many sub-samples of each voxel of a block are inside: of voxel 64·x + 8·y + z, each mod 8.
using BlockCounts = std::array<std::uint8_t, kBlockSide * kBlockSide * kBlockSide>;

/// The columns of sub-samples that make up a column of voxels: 2·(y half) + (z half).
using SubSampleColumns = std::array<BitColumn, 4>;

/// Counts, block by block and x rising, the sub-samples inside of the voxels. Visits runs of blocks
/// that are inside as a whole by `solid`, others that are not empty by `block`.
///
/// N. Nakamura, Y. Inoue, K. Nishio, K. Kobori: "Fast Generation Method from Boundary
/// Representation Model to Binary Voxel Data by Using GPU", section 3.4, steps (4) to (6).
void countSubSamples(const SubSampleColumns& columns,
                     const std::function<void(const SolidRun&)>& solid,
                     const std::function<void(int x, const BlockCounts&)>& block);

}  // namespace bandvox
