#include "resample/gaussian_block_filter.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>

namespace bandvox {

namespace {

using std::numbers::pi;

// Where a Gaussian is cut off, its sum beyond is this part of the tolerance.
constexpr double kTailShare = 1.0 / 16;

// So many voxels of a block together.
constexpr int kGaussianBlock = 32;

// exp(-(k/k_c)²) is the transform of a Gaussian of this variance.
double varianceOf(double cutoff) {
    return 1 / (2 * pi * pi * cutoff * cutoff);
}

// Along an axis of the source, of the Gaussian that lies between the two filters.
double varianceAlong(int axis, const LatticeMap& map, const LatticeFilter& filter) {
    openvdb::Vec3d unit(0.0);
    unit[axis] = 1;
    const double step = map.frequency(unit);
    const double there = filter.before ? varianceOf(filter.before->cutoff) : 0;
    return step * step * varianceOf(filter.kept->cutoff) - there;
}

// What a Gaussian on the nodes leaves of the images of what is in the source.
double imagesOf(double variance, const LatticeFilter& filter) {
    constexpr int kSteps = 64;
    double worst = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double k = 0.5 * i / kSteps;
        const double there = filter.before ? (*filter.before)(k) : 1;
        worst = std::max(worst, there * std::exp(-2 * pi * pi * variance * (1 - k) * (1 - k)));
    }
    return worst;
}

}  // namespace

bool GaussianBlockFilter::isFor(const LatticeMap& map, const LatticeFilter& filter) {
    if (!filter.kept || filter.kept->order != 2 || (filter.before && filter.before->order != 2)) {
        return false;
    }
    if (!map.isDiagonal()) return false;
    for (int axis = 0; axis < 3; ++axis) {
        const double variance = varianceAlong(axis, map, filter);
        if (!(variance > 0) || imagesOf(variance, filter) > 0.5 * filter.tolerance) return false;
    }
    return true;
}

GaussianBlockFilter::GaussianBlockFilter(const LatticeMap& map, const LatticeFilter& filter)
    : BlockFilter(map, 0) {
    mBlockSide = kGaussianBlock;
    for (int axis = 0; axis < 3; ++axis) {
        mVariance[axis] = varianceAlong(axis, map, filter);
        const double sigma = std::sqrt(mVariance[axis]);
        double width = 1;
        while (std::erfc(width / (sigma * std::numbers::sqrt2)) > kTailShare * filter.tolerance) {
            width += 0.25;
        }
        mHalfWidth[axis] = static_cast<int>(std::ceil(width));
        mReach = std::max(mReach, mHalfWidth[axis]);
    }
}

int GaussianBlockFilter::mostNodes(int axis) const {
    const openvdb::Vec3d extent =
        mMap.toSource(openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(mBlockSide - 1)))
            .extents();
    return static_cast<int>(std::ceil(extent[axis])) + 2 * mHalfWidth[axis] + 3;
}

double GaussianBlockFilter::scratchBytes() const {
    return double(sizeof(float)) * mostNodes(0) * mostNodes(1) * mostNodes(2) * 3;
}

SourceCube GaussianBlockFilter::sourceCube(const openvdb::Coord& block) const {
    openvdb::CoordBBox box = sourceBox(block);
    for (int axis = 0; axis < 3; ++axis) {
        box.min()[axis] += mReach - mHalfWidth[axis];
        box.max()[axis] -= mReach - mHalfWidth[axis];
    }
    return {box, box.dim()[1], box.dim()[2]};
}

BlockFilter::Scratch GaussianBlockFilter::allocate() const {
    const std::size_t nodes = std::size_t(mostNodes(0)) * mostNodes(1) * mostNodes(2);
    Scratch scratch{FftBuffer(fftwf_alloc_real(nodes)), {}};
    if (!scratch.cube) throw std::bad_alloc();
    scratch.sums.resize(mBlockSide, std::size_t(mostNodes(1)) * mostNodes(2), mostNodes(2));
    return scratch;
}

AxisTaps GaussianBlockFilter::tapsAlong(int axis, const openvdb::Coord& block,
                                        int cubeOrigin) const {
    const int taps = 2 * mHalfWidth[axis] + 1;
    AxisTaps along;
    along.taps = taps;
    std::vector<double> weights(taps);
    for (int i = 0; i < mBlockSide; ++i) {
        openvdb::Vec3d voxel(0.0);
        voxel[axis] = double(block[axis]) * mBlockSide + i;
        const double place = mMap.toSource(voxel)[axis] - cubeOrigin;
        const int first = static_cast<int>(std::lround(place)) - mHalfWidth[axis];
        double sum = 0;
        for (int t = 0; t < taps; ++t) {
            const double distance = first + t - place;
            weights[t] = std::exp(-0.5 * distance * distance / mVariance[axis]);
            sum += weights[t];
        }
        // So that a constant stays the same.
        for (const double weight : weights) {
            along.weights.push_back(static_cast<float>(weight / sum));
        }
        along.first.push_back(first);
    }
    return along;
}

void GaussianBlockFilter::apply(const openvdb::Coord& block, Scratch& scratch,
                                std::span<float> values) const {
    const SourceCube cube = sourceCube(block);
    const openvdb::Coord& low = cube.box.min();
    const std::size_t row = cube.zStride;
    sumAlongAxes(
        {scratch.cube.get(), row * cube.yCount, row},
        {tapsAlong(0, block, low[0]), tapsAlong(1, block, low[1]), tapsAlong(2, block, low[2])},
        scratch.sums, values);
}

}  // namespace bandvox
