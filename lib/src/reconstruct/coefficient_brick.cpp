#include "reconstruct/coefficient_brick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kLeafSide = Leaf::DIM;

int nodesAlong(const SpreadingKernel& kernel) {
    return CoefficientBrick::kSide + kernel.width();
}

int pitchOf(const SpreadingKernel& kernel) {
    return CoefficientBrick::kSide + kernel.paddedWidth();
}

// The first node under the kernel at the brick's first voxel.
int firstNode(const SpreadingKernel& kernel) {
    return -(kernel.width() / 2);
}

struct ValueRange {
    float low, high;
};

// Copies the cube of `side` voxels from `origin` on, z fastest, a leaf at a time.
ValueRange copyLattice(const openvdb::FloatGrid& grid, const openvdb::Coord& origin, int side,
                       std::vector<float>& lattice) {
    lattice.resize(static_cast<std::size_t>(side) * side * side);
    const openvdb::CoordBBox cube = openvdb::CoordBBox::createCube(origin, side);
    const openvdb::Coord firstLeaf = cube.min() & ~(kLeafSide - 1);
    auto accessor = grid.getConstAccessor();
    ValueRange range{std::numeric_limits<float>::infinity(),
                     -std::numeric_limits<float>::infinity()};
    openvdb::Coord block;
    for (block[0] = firstLeaf[0]; block[0] <= cube.max()[0]; block[0] += kLeafSide) {
        for (block[1] = firstLeaf[1]; block[1] <= cube.max()[1]; block[1] += kLeafSide) {
            for (block[2] = firstLeaf[2]; block[2] <= cube.max()[2]; block[2] += kLeafSide) {
                openvdb::CoordBBox part = openvdb::CoordBBox::createCube(block, kLeafSide);
                part.intersect(cube);
                const Leaf* leaf = accessor.probeConstLeaf(block);
                const float* values = leaf ? leaf->buffer().data() : nullptr;
                const float tile = values ? 0.0F : accessor.getValue(block);
                const int length = part.dim()[2];
                for (int x = part.min()[0]; x <= part.max()[0]; ++x) {
                    for (int y = part.min()[1]; y <= part.max()[1]; ++y) {
                        const openvdb::Coord start(x, y, part.min()[2]);
                        const openvdb::Coord at = start - origin;
                        float* row =
                            &lattice[(static_cast<std::size_t>(at[0]) * side + at[1]) * side +
                                     at[2]];
                        if (!values) {
                            std::fill_n(row, length, tile);
                            continue;
                        }
                        const float* from = values + Leaf::coordToOffset(start);
                        for (int z = 0; z < length; ++z) {
                            row[z] = from[z];
                            range.low = std::min(range.low, from[z]);
                            range.high = std::max(range.high, from[z]);
                        }
                    }
                }
                if (!values) {
                    range.low = std::min(range.low, tile);
                    range.high = std::max(range.high, tile);
                }
            }
        }
    }
    return range;
}

// out[p] = Σ_l a_l in[p + (L + l)·stride], all p in [0, count). Convolves along the axis whose
// neighbours are `stride` apart.
void convolve(const float* in, float* out, std::size_t count, std::size_t stride,
              const std::vector<float>& taps) {
    constexpr std::size_t kLanes = 16;
    const std::size_t reach = taps.size() - 1;
    const float* middle = in + reach * stride;
    std::size_t p = 0;
    for (; p + kLanes <= count; p += kLanes) {
        float sum[kLanes];
        for (std::size_t j = 0; j < kLanes; ++j) sum[j] = taps[0] * middle[p + j];
        for (std::size_t l = 1; l <= reach; ++l) {
            const float* before = middle + p - l * stride;
            const float* after = middle + p + l * stride;
            for (std::size_t j = 0; j < kLanes; ++j) sum[j] += taps[l] * (before[j] + after[j]);
        }
        for (std::size_t j = 0; j < kLanes; ++j) out[p + j] = sum[j];
    }
    for (; p < count; ++p) {
        float sum = taps[0] * middle[p];
        for (std::size_t l = 1; l <= reach; ++l) {
            sum += taps[l] * (middle[p - l * stride] + middle[p + l * stride]);
        }
        out[p] = sum;
    }
}

// The kernel's weights around a place along one axis, and where they start in a brick.
struct AxisWeights {
    int first;
    alignas(64) std::array<float, SpreadingKernel::kPaddedWidth> weights;
    alignas(64) std::array<float, SpreadingKernel::kPaddedWidth> derivatives;
};

AxisWeights axisWeights(const SpreadingKernel& kernel, double local, bool withDerivatives) {
    // Split off the whole voxels first, so that a float holds the rest exactly enough.
    const double whole = std::floor(local);
    const auto rest = static_cast<float>(local - whole);
    AxisWeights axis;
    const int node = withDerivatives
                         ? kernel.weights(rest, axis.weights.data(), axis.derivatives.data())
                         : kernel.weights(rest, axis.weights.data());
    axis.first = static_cast<int>(whole) + node - firstNode(kernel);
    return axis;
}

template <int kLanes>
double sumValue(const float* corner, int width, int nodes, int pitch,
                const std::array<AxisWeights, 3>& axes) {
    float sum[kLanes] = {};
    for (int i = 0; i < width; ++i) {
        const float* plane = corner + static_cast<std::size_t>(i) * nodes * pitch;
        float planeSum[kLanes] = {};
        for (int j = 0; j < width; ++j) {
            const float weight = axes[1].weights[j];
            for (int l = 0; l < kLanes; ++l) planeSum[l] += weight * plane[j * pitch + l];
        }
        for (int l = 0; l < kLanes; ++l) sum[l] += axes[0].weights[i] * planeSum[l];
    }
    double value = 0;
    for (int l = 0; l < kLanes; ++l) value += double(sum[l]) * axes[2].weights[l];
    return value;
}

template <int kLanes>
DensityAt sumEvaluate(const float* corner, int width, int nodes, int pitch,
                      const std::array<AxisWeights, 3>& axes) {
    float sum[kLanes] = {}, sumX[kLanes] = {}, sumY[kLanes] = {};
    for (int i = 0; i < width; ++i) {
        const float* plane = corner + static_cast<std::size_t>(i) * nodes * pitch;
        float planeSum[kLanes] = {}, planeY[kLanes] = {};
        for (int j = 0; j < width; ++j) {
            const float weight = axes[1].weights[j], derivative = axes[1].derivatives[j];
            for (int l = 0; l < kLanes; ++l) {
                planeSum[l] += weight * plane[j * pitch + l];
                planeY[l] += derivative * plane[j * pitch + l];
            }
        }
        const float weight = axes[0].weights[i], derivative = axes[0].derivatives[i];
        for (int l = 0; l < kLanes; ++l) {
            sum[l] += weight * planeSum[l];
            sumX[l] += derivative * planeSum[l];
            sumY[l] += weight * planeY[l];
        }
    }
    DensityAt at;
    for (int l = 0; l < kLanes; ++l) {
        at.value += double(sum[l]) * axes[2].weights[l];
        at.gradient[0] += double(sumX[l]) * axes[2].weights[l];
        at.gradient[1] += double(sumY[l]) * axes[2].weights[l];
        at.gradient[2] += double(sum[l]) * axes[2].derivatives[l];
    }
    return at;
}

}  // namespace

std::size_t CoefficientBrick::bytes(const SpreadingKernel& kernel) {
    const std::size_t nodes = nodesAlong(kernel);
    return nodes * nodes * pitchOf(kernel) * sizeof(float) + sizeof(CoefficientBrick);
}

CoefficientBrick::CoefficientBrick(const openvdb::FloatGrid& grid, const openvdb::Coord& brick,
                                   const InterpolationDesign& design, BrickScratch& scratch)
    : mNodes(nodesAlong(design.kernel)), mPitch(pitchOf(design.kernel)) {
    // Copy the lattice under the brick and its halo. The kernel's last nodes along z, which lie
    // in the padding, have no weight and stay 0.
    const int reach = design.reach();
    const int side = mNodes + 2 * reach;
    const openvdb::Coord origin(brick[0] * kSide, brick[1] * kSide, brick[2] * kSide);
    const ValueRange range =
        copyLattice(grid, origin.offsetBy(firstNode(design.kernel) - reach), side, scratch.lattice);
    if (range.low == range.high) {
        mConstant = range.low;
        return;
    }

    // Convolve along x, then y, then z; each pass leaves fewer planes, rows, or nodes.
    const std::vector<float> taps(design.prefilter.begin(), design.prefilter.end());
    const std::size_t rowLength = side, plane = rowLength * side, nodes = mNodes;
    scratch.filtered.resize(nodes * plane);
    convolve(scratch.lattice.data(), scratch.filtered.data(), nodes * plane, plane, taps);
    for (std::size_t x = 0; x < nodes; ++x) {
        convolve(&scratch.filtered[x * plane], &scratch.lattice[x * nodes * rowLength],
                 nodes * rowLength, rowLength, taps);
    }
    mCoefficients.assign(nodes * nodes * mPitch, 0.0F);
    for (std::size_t row = 0; row < nodes * nodes; ++row) {
        convolve(&scratch.lattice[row * rowLength], &mCoefficients[row * mPitch], nodes, 1, taps);
    }
}

double CoefficientBrick::value(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const {
    if (mCoefficients.empty()) return mConstant;
    std::array<AxisWeights, 3> axes;
    for (int a = 0; a < 3; ++a) axes[a] = axisWeights(kernel, local[a], false);
    const std::size_t row = static_cast<std::size_t>(axes[0].first) * mNodes + axes[1].first;
    const float* corner = &mCoefficients[row * mPitch + axes[2].first];
    return kernel.paddedWidth() == 8 ? sumValue<8>(corner, kernel.width(), mNodes, mPitch, axes)
                                     : sumValue<16>(corner, kernel.width(), mNodes, mPitch, axes);
}

DensityAt CoefficientBrick::evaluate(const SpreadingKernel& kernel,
                                     const openvdb::Vec3d& local) const {
    if (mCoefficients.empty()) return {mConstant, {0, 0, 0}};
    std::array<AxisWeights, 3> axes;
    for (int a = 0; a < 3; ++a) axes[a] = axisWeights(kernel, local[a], true);
    const std::size_t row = static_cast<std::size_t>(axes[0].first) * mNodes + axes[1].first;
    const float* corner = &mCoefficients[row * mPitch + axes[2].first];
    return kernel.paddedWidth() == 8
               ? sumEvaluate<8>(corner, kernel.width(), mNodes, mPitch, axes)
               : sumEvaluate<16>(corner, kernel.width(), mNodes, mPitch, axes);
}

}  // namespace bandvox
