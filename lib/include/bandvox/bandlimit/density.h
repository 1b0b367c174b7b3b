#pragma once

#include <bandvox/core/shard.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bandvox {

/// How a solid is band-limited.
struct DensityOptions {
    int resolution = 256;      ///< voxels along the longest side of the source's box; 1 to 2^20
    double voxelSize = 0;      ///< world units; if > 0 it is used instead of `resolution`
    ExponentialFilter filter;  ///< transfer function; order 1 to 64, cutoff 0.01 to 0.5
    double tolerance = 1e-4;   ///< error allowed, density; 1e-6 to 0.05
    int tile = 0;              ///< side of the cube that one FFT filters, voxels, even, up to 512;
                               ///< 0 chooses
    bool clamp = false;        ///< limit the density to [0, 1] (cuts off ringing)
    bool sumOverlaps = false;  ///< exact route: let shells that overlap add up beyond 1
    double iso = 0.5;          ///< density that is the surface, in (0, 1); stored for later stages
    Shard shard;               ///< part of the grid that is made (joinShards); it may be empty
};

/// A density grid and what was measured while it was made.
struct DensityResult {
    openvdb::FloatGrid::Ptr grid;       ///< named "density", metadata set
    DensityMetadata metadata;           ///< as stored in the grid
    std::int64_t surfaceSamples = 0;    ///< exact route: quadrature points, once for each tile
    std::int64_t fieldSamples = 0;      ///< sampled route: values asked for, once for each tile
    std::int64_t tiles = 0;             ///< tiles transformed
    int tileSide = 0;                   ///< voxels, halo included
    int halo = 0;                       ///< voxels on each side of a tile
    int kernelWidth = 0;                ///< exact route: of the spreading kernel, voxels
    double minimum = 0, maximum = 0;    ///< of the density over all voxels, limited if it is
    double spreadSeconds = 0;           ///< processor time of all threads before the transforms
    double transformSeconds = 0;        ///< the same in transforms
    bool overlaps = false;              ///< shells of the surface overlap, as far as is seen here
    int refinements = 0;                ///< how often the quadrature was made finer
    std::vector<std::string> warnings;  ///< in words, for the user
};

}  // namespace bandvox
