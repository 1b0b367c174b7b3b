#include "resample/spectral_block_filter.h"

#include "core/words.h"
#include "reconstruct/brick_sums.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

// Of the tolerance.
constexpr double kReadingShare = 1.0 / 4;

// What transforms fast.
constexpr std::array kSides{48, 64, 80, 96, 128, 160, 192, 256};

constexpr int kBlockStep = 8;  // the side of a leaf
constexpr int kLargestBlock = 128;

// Along each axis of the source, the distance between the outermost places of a block.
openvdb::Vec3d extentOf(const LatticeMap& map, int blockSide) {
    const double last = blockSide - 1;
    return map.toSource(openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(last))).extents();
}

// The largest block that a cube has room for; 0 if there is none.
int largestBlock(const LatticeMap& map, int side, int reach) {
    int block = 0;
    for (int next = kBlockStep; next <= kLargestBlock; next += kBlockStep) {
        const openvdb::Vec3d extent = extentOf(map, next);
        // Two voxels more, since the cube begins on a voxel.
        if (std::max({extent[0], extent[1], extent[2]}) + 2 * reach + 2 > side) break;
        block = next;
    }
    return block;
}

// The filter, isotropic on the source's lattice, that leaves at least as much as what is kept.
ExponentialFilter widest(const LatticeMap& map, const LatticeFilter& filter) {
    if (!filter.kept) return filter.before.value_or(ExponentialFilter{});
    return {filter.kept->order, filter.kept->cutoff / map.finest()};
}

InterpolationDesign design(const LatticeMap& map, const LatticeFilter& filter) {
    if (!filter.kept && !filter.before) return splineInterpolation();
    constexpr double kCoarsestTolerance = 0.1;
    // Sharp filters keep more than can be read to a fine tolerance: then read as well as can be.
    for (double tolerance = kReadingShare * filter.tolerance;; tolerance *= 2) {
        try {
            return designInterpolation(widest(map, filter), std::min(tolerance, 0.1));
        } catch (const Error&) {
            if (tolerance >= kCoarsestTolerance) throw;
        }
    }
}

}  // namespace

SpectralBlockFilter::SpectralBlockFilter(const LatticeMap& map, const LatticeFilter& filter)
    : BlockFilter(map, filter.reach(map)),
      mIsAligned(map.isAligned()),
      mIsDiagonal(map.isDiagonal()),
      mDesign(design(map, filter)),
      mFft(RealFft3::get(
          chooseSide(map,
                     mReach += mIsAligned ? 0 : mDesign.reach() + mDesign.kernel.width() / 2 + 1),
          0, 0, 0, SpectrumLayout::Packed)),
      mTransfer(transferOf(filter)) {
    mBlockSide = largestBlock(map, mFft.size(), mReach);
}

// The side that costs least for a surface, which meets as many blocks as their faces are small.
int SpectralBlockFilter::chooseSide(const LatticeMap& map, int reach) {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const int side : kSides) {
        const double block = largestBlock(map, side, reach);
        // Small cubes stay in the cache.
        constexpr double kCached = 64;
        const double cost = std::pow(side, 3) * (1 + side / kCached) / (block * block);
        if (block > 0 && cost < least) {
            best = side;
            least = cost;
        }
    }
    if (best > 0) return best;
    throw Error(ErrorKind::Usage,
                "the filter reaches " + std::to_string(reach) +
                    " voxels of the grid, and a transform of " + std::to_string(kSides.back()) +
                    " has no room for that; lower its order, or raise its cutoff or the tolerance");
}

double SpectralBlockFilter::scratchBytes() const {
    double floats = static_cast<double>(mFft.bufferSize());
    if (mIsDiagonal && !mIsAligned) {
        floats += double(mBlockSide) * (mFft.yCount() + mBlockSide) * mFft.zStride();
    }
    return double(sizeof(float)) * floats;
}

BlockFilter::Scratch SpectralBlockFilter::allocate() const {
    Scratch scratch{mFft.allocate(), {}};
    if (mIsDiagonal && !mIsAligned) {
        const auto row = static_cast<std::size_t>(mFft.zStride());
        scratch.sums.resize(mBlockSide, row * mFft.yCount(), row);
    }
    return scratch;
}

AxisTaps SpectralBlockFilter::tapsAlong(int axis, const openvdb::Coord& block,
                                        int cubeOrigin) const {
    const SpreadingKernel& kernel = mDesign.kernel;
    AxisTaps along;
    along.taps = kernel.width();
    for (int i = 0; i < mBlockSide; ++i) {
        openvdb::Vec3d voxel(0.0);
        voxel[axis] = double(block[axis]) * mBlockSide + i;
        const double place = mMap.toSource(voxel)[axis] - cubeOrigin;
        const NodeWeights nodes = nodeWeights(kernel, place + firstNode(kernel));
        along.first.push_back(nodes.first);
        along.weights.insert(along.weights.end(), nodes.weights.begin(),
                             nodes.weights.begin() + along.taps);
    }
    return along;
}

SourceCube SpectralBlockFilter::sourceCube(const openvdb::Coord& block) const {
    return {openvdb::CoordBBox::createCube(sourceBox(block).min(), mFft.size()), mFft.yCount(),
            mFft.zStride()};
}

PackedFilter SpectralBlockFilter::transferOf(const LatticeFilter& filter) const {
    const int side = mFft.size(), half = side / 2;
    // The response of the prefilter along an axis, by the frequency's magnitude.
    std::vector<double> reading(half + 1, 1.0);
    for (int i = 0; !mIsAligned && i <= half; ++i) {
        double sum = mDesign.prefilter[0];
        for (int l = 1; l <= mDesign.reach(); ++l) {
            sum += 2 * mDesign.prefilter[l] * std::cos(2 * std::numbers::pi * i * l / side);
        }
        reading[i] = sum;
    }
    // A packed transform and its inverse make side³ / 2 of what was there.
    const double scale = 2 / std::pow(side, 3);
    const auto transfer = [&](int x, int y, int z) {
        const openvdb::Vec3d k = openvdb::Vec3d(x, y, z) / side;
        return scale * reading[std::abs(x)] * reading[std::abs(y)] * reading[std::abs(z)] *
               filter(mMap, k);
    };
    return {mFft, transfer, false};
}

void SpectralBlockFilter::apply(const openvdb::Coord& block, Scratch& scratch,
                                std::span<float> values) const {
    float* cube = scratch.cube.get();
    mFft.forward(cube);
    mTransfer.multiply(cube);
    mFft.inverse(cube);
    if (mIsDiagonal && !mIsAligned) {
        const openvdb::Coord low = sourceBox(block).min();
        const auto row = static_cast<std::size_t>(mFft.zStride());
        return sumAlongAxes(
            {cube, row * mFft.yCount(), row},
            {tapsAlong(0, block, low[0]), tapsAlong(1, block, low[1]), tapsAlong(2, block, low[2])},
            scratch.sums, values);
    }
    const BrickNodes nodes{cube, mFft.yCount(), mFft.zStride()};
    const openvdb::Vec3d first = block.asVec3d() * mBlockSide;
    const openvdb::Vec3d origin = sourceBox(block).min().asVec3d();
    const openvdb::Vec3d shift(firstNode(mDesign.kernel));
    std::size_t i = 0;
    for (int x = 0; x < mBlockSide; ++x) {
        for (int y = 0; y < mBlockSide; ++y) {
            for (int z = 0; z < mBlockSide; ++z, ++i) {
                const openvdb::Vec3d place =
                    mMap.toSource(first + openvdb::Vec3d(x, y, z)) - origin;
                if (mIsAligned) {
                    const openvdb::Coord at = openvdb::Coord::round(place);
                    values[i] =
                        cube[(std::size_t(at[0]) * nodes.nodes + at[1]) * nodes.pitch + at[2]];
                } else {
                    values[i] = static_cast<float>(sumValue(nodes, mDesign.kernel, place + shift));
                }
            }
        }
    }
}

}  // namespace bandvox
