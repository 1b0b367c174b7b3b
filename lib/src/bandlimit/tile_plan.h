#pragma once

#include <bandvox/bandlimit/density.h>
#include <bandvox/source/quadrature.h>
#include <bandvox/spectral/spreading_kernel.h>

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

namespace bandvox {

/// What of the tolerance concerns tiles whatever fills them, and what follows from it. All lengths
/// in voxels. docs/math/exact-route.md derives the shares.
struct TileGeometry {
    ExponentialFilter filter;
    double tolerance;
    int halo;          ///< on each side of the interior; the filter's reach, rounded up
    int side;          ///< of the cube that is transformed
    int interior;      ///< side - 2 halo: of the cube that is kept
    double threshold;  ///< density; values nearer to a whole number than this are stored as it
};

/// The halo is no less than `leastHalo`. Throws Error(ErrorKind::Usage) if the tile asked for does
/// not hold its own halo.
TileGeometry makeTileGeometry(const DensityOptions& options, int leastHalo = 0);

/// The same, and what the exact route needs beside it.
struct TilePlan : TileGeometry {
    SpreadingKernel kernel;
    SurfaceQuadrature quadrature;
};

/// Throws as makeTileGeometry.
TilePlan makeTilePlan(const DensityOptions& options);

/// Where the tiles lie. The layout moves with the object by whole voxels, so that a shifted
/// object gives the same numbers in shifted places.
struct TileLayout {
    double voxelSize;       ///< world units
    openvdb::Coord origin;  ///< first voxel of the first tile's interior
    openvdb::Coord count;   ///< tiles along each axis
    int interior;

    /// First voxel of a tile's interior.
    openvdb::Coord tileOrigin(const openvdb::Coord& tile) const {
        return origin +
               openvdb::Coord(tile.x() * interior, tile.y() * interior, tile.z() * interior);
    }
};

/// Throws Error(ErrorKind::Usage) if voxel indices would not fit OpenVDB's.
TileLayout layOutTiles(const openvdb::BBoxd& bounds, double voxelSize,
                       const TileGeometry& geometry);

}  // namespace bandvox
