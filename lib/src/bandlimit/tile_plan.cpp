#include "bandlimit/tile_plan.h"

#include "bandlimit/surface_quadrature.h"
#include "core/words.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace bandvox {

namespace {

// Shares of the tolerance, for errors that may all add up; the twentieth that is left covers
// rounding.
constexpr double kHaloShare = 1.0 / 4;
constexpr double kKernelShare = 1.0 / 8;
constexpr double kQuadratureShare = 1.0 / 5;
constexpr double kStorageShare = 3.0 / 8;

// 64³ samples stay in a core's second-level cache, and 64 is the size that transforms fastest
// per sample. Where the halo leaves too little of it, the next power of two is better.
constexpr int kTileSides[] = {64, 128, 256};
constexpr double kSmallestInteriorShare = 0.4;

constexpr double kLargestIndex = 1 << 30;

int chooseSide(int halo) {
    for (const int side : kTileSides) {
        if (side - 2 * halo >= kSmallestInteriorShare * side) return side;
    }
    return 2 * kTileSides[2];
}

SpreadingKernel chooseKernel(const ExponentialFilter& filter, double tolerance) {
    // What the lattice cannot hold, it cannot be spread to either, and trying amplifies rounding:
    // ask no more of the kernel than a tenth of what the filter leaves at Nyquist.
    for (double asked = std::max(tolerance, 0.1 * filter.atNyquist());; asked *= 2) {
        try {
            return SpreadingKernel::forFilter(filter, asked);
        } catch (const Error&) {
            if (asked > 1) throw;
        }
    }
}

}  // namespace

TileGeometry makeTileGeometry(const DensityOptions& options, int leastHalo) {
    const int reach =
        static_cast<int>(std::ceil(filterReach(options.filter, kHaloShare * options.tolerance)));
    const int halo = std::max(reach, leastHalo);
    const int side = options.tile > 0 ? options.tile : chooseSide(halo);
    if (side - 2 * halo < 2) {
        throw Error(ErrorKind::Usage,
                    "a tile of " + std::to_string(side) +
                        " voxels does not hold its halo: the "
                        "filter reaches " +
                        std::to_string(halo) +
                        " voxels on each side at this tolerance, so it must be at least " +
                        std::to_string(2 * halo + 2));
    }
    return TileGeometry{options.filter, options.tolerance, halo,
                        side,           side - 2 * halo,   kStorageShare * options.tolerance};
}

TilePlan makeTilePlan(const DensityOptions& options) {
    SpreadingKernel kernel = chooseKernel(options.filter, kKernelShare * options.tolerance);
    // Nodes are counted from half a kernel's width before the tile, which has to be halo.
    const TileGeometry geometry = makeTileGeometry(options, kernel.width() / 2 + 2);
    return TilePlan{geometry, std::move(kernel),
                    chooseQuadrature(options.filter, kQuadratureShare * options.tolerance)};
}

TileLayout layOutTiles(const openvdb::BBoxd& bounds, double voxelSize,
                       const TileGeometry& geometry) {
    const openvdb::Vec3d low = bounds.min() / voxelSize;
    const openvdb::Vec3d high = bounds.max() / voxelSize;
    openvdb::Coord origin, count;
    for (int axis = 0; axis < 3; ++axis) {
        // Written so that a NaN fails too.
        if (!(low[axis] > -kLargestIndex && high[axis] < kLargestIndex)) {
            throw Error(ErrorKind::Usage, "with voxels of " + inShort(voxelSize) +
                                              " world units the object reaches index " +
                                              inShort(std::max(-low[axis], high[axis])) +
                                              ", and indices must stay below 2^30");
        }
        // The density reaches as far as the filter does; one voxel more makes the first
        // difference start from 0.
        origin[axis] = static_cast<int>(std::floor(low[axis])) - geometry.halo - 1;
        const auto end = static_cast<std::int64_t>(std::ceil(high[axis])) + geometry.halo + 2;
        count[axis] =
            static_cast<int>((end - origin[axis] + geometry.interior - 1) / geometry.interior);
    }
    return TileLayout{voxelSize, origin, count, geometry.interior};
}

}  // namespace bandvox
