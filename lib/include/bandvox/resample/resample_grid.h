#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/core/shard.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <optional>

namespace bandvox {

/// How a grid is brought to another lattice.
struct ResampleOptions {
    /// What is kept, in cycles per voxel of the new lattice; order 1 to 64, cutoff 0.01 to 0.5.
    /// Nothing: the grid is only read between its nodes, and aliases where voxels become larger.
    std::optional<ExponentialFilter> filter = ExponentialFilter{};
    double tolerance = 1e-4;  ///< error allowed, relative to the largest difference from the
                              ///< background; 1e-6 to 0.05
    Shard shard;              ///< part of the new grid that is made (joinShards)
};

/// A grid on another lattice, and what was done.
struct ResampleResult {
    openvdb::FloatGrid::Ptr grid;
    std::int64_t steps = 0;           ///< lattices that it was brought to, the last one included
    std::int64_t blocks = 0;          ///< cubes that were transformed
    double amplitude = 0;             ///< largest difference of a value from the background
    double minimum = 0, maximum = 0;  ///< of the new values, background included
};

/// Low-pass filters a grid and samples the result at the voxel centres of another lattice, which
/// may have voxels of any size, shape and direction:
///
///     f~(y) = (g * f)(A y + b),   ĝ(k) = H(|Aᵀk|),
///
/// x = A y + b being the place, in the source's voxels, of voxel y. H is `filter`; where new voxels
/// are smaller than the source's, frequencies count as if they were as large. A density of this
/// library has a filter in it already, H_0: of such a grid ĝ = H(|Aᵀk|) / H_0(|k|), at most 4, so
/// that the result is what the source would have become on the new lattice at once. Frequencies are
/// removed before sampling, so nothing aliases; tiles stay tiles.
///
/// Blocks of the new lattice are made each by two transforms of the voxels that matter to it and
/// are read between the nodes as by makeBrickReconstruction; larger steps than 3 voxels are made
/// of several (docs/math/resampling.md). Voxels nearer to the background than three eighths of the
/// tolerance become background and inactive, as in convert; metadata, name and class are kept, but
/// for the filter's. A density of this library stays one.
///
/// Throws Error(ErrorKind::Usage) for options out of range or a transform that is not linear,
/// Error(ErrorKind::Input) for a source with values that are not finite, or whose transform is not
/// linear, Error(ErrorKind::Memory) before allocating if it would not fit,
/// Error(ErrorKind::Interrupted).
ResampleResult resampleGrid(const openvdb::FloatGrid::ConstPtr& source,
                            const openvdb::math::Transform& target,
                            const ResampleOptions& options = {},
                            Progress& progress = silentProgress());

/// The lattice with cubic voxels of this side, world units, whose axes have the directions of the
/// grid's and whose voxel 0 lies where the grid's does.
openvdb::math::Transform::Ptr uniformLattice(const openvdb::GridBase& grid, double voxelSize);

}  // namespace bandvox
