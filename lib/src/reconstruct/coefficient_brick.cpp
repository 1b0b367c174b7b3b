#include "reconstruct/coefficient_brick.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"
#include "grid/copy_box.h"

#include <algorithm>
#include <span>

namespace bandvox {

namespace {

int nodesAlong(const SpreadingKernel& kernel) {
    return CoefficientBrick::kSide + kernel.width();
}

int pitchOf(const SpreadingKernel& kernel) {
    return CoefficientBrick::kSide + kernel.paddedWidth();
}

// `count` rows of `length` outputs each, so far apart.
struct ConvolutionRows {
    std::size_t count, length, inPitch, outPitch;
};

// out[p] = Σ_l a_l in[p + (L + l)·stride] for kCount outputs from p on, in double precision.
template <int kCount>
[[gnu::always_inline]] inline void convolveSome(const float* middle, float* out, std::size_t stride,
                                                std::span<const double> taps) {
    double sum[kCount];
    for (int p = 0; p < kCount; ++p) sum[p] = taps[0] * middle[p];
    for (std::size_t l = 1; l < taps.size(); ++l) {
        const float* before = middle - l * stride;
        const float* after = middle + l * stride;
        for (int p = 0; p < kCount; ++p) sum[p] += taps[l] * (double(before[p]) + after[p]);
    }
    for (int p = 0; p < kCount; ++p) out[p] = static_cast<float>(sum[p]);
}

// The same in single precision.
template <int kCount>
[[gnu::always_inline]] inline void convolveSome(const float* middle, float* out, std::size_t stride,
                                                std::span<const float> taps) {
    constexpr int kLanes = 8, kVectors = kCount / kLanes;
    Lanes<kLanes> sum[kVectors], before, after;
    for (int p = 0; p < kVectors; ++p) {
        loadLanes<kLanes>(middle + p * kLanes, before);
        sum[p] = taps[0] * before;
    }
    for (std::size_t l = 1; l < taps.size(); ++l) {
        for (int p = 0; p < kVectors; ++p) {
            loadLanes<kLanes>(middle - l * stride + p * kLanes, before);
            loadLanes<kLanes>(middle + l * stride + p * kLanes, after);
            sum[p] += taps[l] * (before + after);
        }
    }
    for (int p = 0; p < kVectors; ++p) storeLanes<kLanes>(sum[p], out + p * kLanes);
}

// Convolves along the axis whose neighbours are `stride` apart.
template <typename Tap>
[[gnu::always_inline]] inline void convolveRows(const float* in, float* out,
                                                const ConvolutionRows& rows, std::size_t stride,
                                                std::span<const Tap> taps) {
    constexpr std::size_t kMany = 32, kFew = 8;
    const std::size_t reach = taps.size() - 1;
    for (std::size_t row = 0; row < rows.count; ++row) {
        const float* middle = in + row * rows.inPitch + reach * stride;
        float* to = out + row * rows.outPitch;
        std::size_t p = 0;
        for (; p + kMany <= rows.length; p += kMany) {
            convolveSome<kMany>(middle + p, to + p, stride, taps);
        }
        for (; p + kFew <= rows.length; p += kFew) {
            convolveSome<kFew>(middle + p, to + p, stride, taps);
        }
        // The last ones together with some that have been done.
        p = std::min(p, rows.length - kFew);
        convolveSome<kFew>(middle + p, to + p, stride, taps);
    }
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void convolve(const float* in, float* out, const ConvolutionRows& rows, std::size_t stride,
              std::span<const double> taps) {
    convolveRows(in, out, rows, stride, taps);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void convolveSingle(const float* in, float* out, const ConvolutionRows& rows, std::size_t stride,
                    std::span<const float> taps) {
    convolveRows(in, out, rows, stride, taps);
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
    const std::size_t rowLength = side, plane = rowLength * side;
    scratch.lattice.resize(plane * side);
    const openvdb::CoordBBox cube =
        openvdb::CoordBBox::createCube(origin.offsetBy(firstNode(design.kernel) - reach), side);
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> values(grid.tree());
    if (copyBox(values, cube, scratch.lattice.data(), plane, rowLength)) {
        mConstant = scratch.lattice.front();
        return;
    }

    // Convolve along x, then y, then z; each pass leaves fewer planes, rows, or nodes.
    const std::vector<float> single(design.prefilter.begin(), design.prefilter.end());
    const auto pass = [&](const float* in, float* out, const ConvolutionRows& rows,
                          std::size_t stride) {
        if (design.singlePrecision) {
            convolveSingle(in, out, rows, stride, single);
        } else {
            convolve(in, out, rows, stride, design.prefilter);
        }
    };
    const std::size_t nodes = mNodes, pitch = mPitch;
    scratch.filtered.resize(nodes * plane);
    pass(scratch.lattice.data(), scratch.filtered.data(), {1, nodes * plane, 0, 0}, plane);
    pass(scratch.filtered.data(), scratch.lattice.data(),
         {nodes, nodes * rowLength, plane, nodes * rowLength}, rowLength);
    mCoefficients = std::make_unique_for_overwrite<float[]>(nodes * nodes * pitch);
    pass(scratch.lattice.data(), mCoefficients.get(), {nodes * nodes, nodes, rowLength, pitch}, 1);
    for (std::size_t row = 0; row < nodes * nodes; ++row) {
        std::fill_n(&mCoefficients[row * pitch + nodes], pitch - nodes, 0.0F);
    }
}

double CoefficientBrick::value(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const {
    return !mCoefficients ? mConstant : sumValue(nodes(), kernel, local);
}

DensityAt CoefficientBrick::evaluate(const SpreadingKernel& kernel,
                                     const openvdb::Vec3d& local) const {
    if (!mCoefficients) return {mConstant, {0, 0, 0}};
    return sumGradient(nodes(), kernel, local);
}

DensityExpansion CoefficientBrick::expand(const SpreadingKernel& kernel,
                                          const openvdb::Vec3d& local) const {
    if (!mCoefficients) return {mConstant, {0, 0, 0}, openvdb::Mat3d::zero()};
    return sumHessian(nodes(), kernel, local);
}

}  // namespace bandvox
