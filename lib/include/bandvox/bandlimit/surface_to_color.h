#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/core/shard.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstdint>

namespace bandvox {

/// How the colours of a surface are band-limited.
struct ColorOptions {
    double voxelSize = 0;      ///< world units, > 0; that of the density's grid
    ExponentialFilter filter;  ///< of the density; see colorFilter
    int tile = 0;              ///< side of the cube that one FFT filters, voxels, even, up to 512;
                               ///< 0 chooses
    Shard shard;               ///< part of the grid that is made (joinShards); it may be empty
};

/// A grid of colours and what was counted while it was made.
struct ColorResult {
    openvdb::Vec3SGrid::Ptr grid;     ///< named "Cd", vector type invariant, linear light
    std::int64_t surfaceSamples = 0;  ///< quadrature points, once for each tile
    std::int64_t tiles = 0;           ///< tiles transformed
};

/// The filter h of the colours that belong to a density: a Gaussian with the half-power frequency
/// of the density's filter, and a cutoff of at most 0.16. A mean needs weights that are not
/// negative, and of the filters that do not ring a lattice cannot hold more. For the default
/// filter of densities, and all Gaussians below it, it is that filter.
ExponentialFilter colorFilter(const ExponentialFilter& density);

/// The colour that a surface has around each voxel: with c(x) the colour on the surface S,
///     Cd = (h * (c δ_S)) / (h * δ_S),
/// where h * δ_S is more than a hundredth of what it is on a flat face; elsewhere voxels are
/// inactive (docs/math/color.md). Values lie between those of c; index 0 is at the world's origin.
///
/// The order and orientation of the triangles, holes and overlaps do not matter, since only
/// places and areas count.
/// Throws Error(ErrorKind::Usage) for options out of range, Error(ErrorKind::Memory) before
/// allocating if it would not fit, Error(ErrorKind::Result) if the grid would be empty,
/// Error(ErrorKind::Interrupted).
ColorResult surfaceToColor(const ColoredMesh& mesh, const ColorOptions& options,
                           Progress& progress = silentProgress());

}  // namespace bandvox
