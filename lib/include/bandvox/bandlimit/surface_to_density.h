#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/boundary_source.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bandvox {

/// How a solid is band-limited.
struct DensityOptions {
    int resolution = 256;      ///< voxels along the longest side of the source's box; ≥ 1
    double voxelSize = 0;      ///< world units; if > 0 it is used instead of `resolution`
    ExponentialFilter filter;  ///< transfer function
    double tolerance = 1e-4;   ///< error allowed, density; 1e-6 to 0.05
    int tile = 0;              ///< side of the cube that one FFT filters, voxels; 0 chooses
    bool clamp = false;        ///< limit the density to [0, 1] (cuts off ringing)
    double iso = 0.5;          ///< density that is the surface; stored for later stages
};

/// A density grid and what was measured while it was made.
struct DensityResult {
    openvdb::FloatGrid::Ptr grid;       ///< named "density", metadata set
    DensityMetadata metadata;           ///< as stored in the grid
    std::int64_t surfaceSamples = 0;    ///< quadrature points spread, counted once per tile
    std::int64_t tiles = 0;             ///< tiles transformed
    int tileSide = 0;                   ///< voxels, halo included
    int halo = 0;                       ///< voxels on each side of a tile
    int kernelWidth = 0;                ///< of the spreading kernel, voxels
    double minimum = 0, maximum = 0;    ///< of the density over all voxels computed
    double spreadSeconds = 0;           ///< processor time of all threads in sampling and spreading
    double transformSeconds = 0;        ///< the same in transforms
    std::vector<std::string> warnings;  ///< in words, for the user
};

/// Turns the solid inside a closed surface into a band-limited density grid, by the exact route:
/// the solid is never sampled; its derivative along x, which lives on the surface, is
/// integrated, filtered in tiles, and summed up again (docs/math/exact-route.md).
///
/// The grid's index 0 lies at the world's origin. It is active wherever the density exceeds the
/// tolerance, and deep inside it is made of active tiles of value 1.
/// Throws Error(ErrorKind::Usage) for options out of range, Error(ErrorKind::Memory) before
/// allocating if it would not fit, Error(ErrorKind::Result) if the measured error is above the
/// tolerance, Error(ErrorKind::Interrupted).
DensityResult surfaceToDensity(const BoundarySource& source, const DensityOptions& options = {},
                               Progress& progress = silentProgress());

}  // namespace bandvox
