#include "voxelize/gpu_tiles.h"

#include "voxelize/bit_column.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bandvox {

namespace {

// With 17 bits of fraction, coordinates below this take 31 bits. Two blocks less: a lattice starts
// anywhere in its first one, and what is behind the last sample has to be counted as well.
constexpr int kMostSamples = (1 << 14) - 2 * kBlockSide;
constexpr std::int64_t kBlockBytes = kBlockSide * std::int64_t(sizeof(Rows));
constexpr int kLeastSide = 2;  // columns of a tile, so that the sub-samples of a voxel are in one

int evenAtMost(std::int64_t n) {
    return static_cast<int>(std::max<std::int64_t>(n / kLeastSide * kLeastSide, kLeastSide));
}

}  // namespace

void requireGpuLattice(const VoxelLattice& samples) {
    const openvdb::Coord size = samples.voxels.dim();
    const int longest = std::max({size.x(), size.y(), size.z()});
    if (longest <= kMostSamples) return;
    std::ostringstream message;
    message << "the GPU takes at most " << kMostSamples
            << " samples along a side (half as many voxels where each has sub-samples); expected "
            << "no more, or the CPU, but found " << longest;
    throw Error(ErrorKind::Usage, message.str());
}

openvdb::CoordBBox GpuTile::samples(int begin, int end) const {
    return {openvdb::Coord(begin, mBegin.y(), mBegin.z()) << kBlockLog2,
            (openvdb::Coord(end, mEnd.y(), mEnd.z()) << kBlockLog2).offsetBy(-1)};
}

GpuTiling::GpuTiling(const VoxelLattice& samples, GpuMethod method, const GpuLimits& limits) {
    const openvdb::Coord& count = samples.blockCount;
    // The first sample behind a face on the far side may be the one after the last.
    const int depth = (samples.voxels.max().x() + 1 - samples.corner().x()) / kBlockSide + 1;

    // Prefer whole rows: they are drawn once. Then tiles as square as can be.
    const int mostColumns = evenAtMost(limits.side / kBlockSide);
    const std::int64_t blocks = limits.bufferBytes / kBlockBytes;
    mPassDepth = depth;
    int side = mostColumns;
    if (method == GpuMethod::Bits) {
        mPassDepth = static_cast<int>(
            std::clamp<std::int64_t>(blocks / (kLeastSide * kLeastSide), 1, depth));
        const double square = std::sqrt(static_cast<double>(blocks) / mPassDepth);
        side = std::min(mostColumns, evenAtMost(static_cast<std::int64_t>(square)));
    }
    const int height = std::min(side, evenAtMost(count.y() + 1));
    int width = std::min(side, evenAtMost(count.z() + 1));
    if (method == GpuMethod::Bits) {
        // Where the lattice is low, it may be wide.
        const std::int64_t room = blocks / (std::int64_t(mPassDepth) * height);
        width = std::min({mostColumns, evenAtMost(room), evenAtMost(count.z() + 1)});
    }
    for (int y = 0; y < count.y(); y += height) {
        for (int z = 0; z < count.z(); z += width) {
            mTiles.emplace_back(samples, openvdb::Coord(0, y, z),
                                openvdb::Coord(depth, std::min(y + height, count.y()),
                                               std::min(z + width, count.z())));
        }
    }
    const auto tiles = static_cast<std::int64_t>(mTiles.size());
    const std::int64_t columns = std::int64_t(height) * width;
    if (method == GpuMethod::Bits) {
        mSteps = tiles * ((depth + mPassDepth - 1) / mPassDepth);
        mBytes = columns * mPassDepth * kBlockBytes;
    } else {
        mSteps = tiles * (std::int64_t(depth) * kBlockSide + 1);
        mBytes = columns * kBlockSide * kBlockSide * std::int64_t(sizeof(float));
    }
}

}  // namespace bandvox
