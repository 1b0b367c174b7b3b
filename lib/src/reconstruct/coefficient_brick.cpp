#include "reconstruct/coefficient_brick.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"
#include "grid/copy_box.h"
#include "reconstruct/nodes_in_band.h"

#include <algorithm>
#include <array>
#include <span>

namespace bandvox {

namespace {

// Boxes that hold more of a brick than this are not worth the making.
constexpr double kNearlyWhole = 0.75;

const openvdb::CoordBBox kWholeBrick =
    openvdb::CoordBBox::createCube(openvdb::Coord(0), CoefficientBrick::kSide);

// The voxels of a brick, relative to its first, in which places are mostly read.
openvdb::CoordBBox mostlyReadVoxels(
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false>& values,
    const openvdb::Coord& origin, const DensityBand& band) {
    openvdb::CoordBBox nodes = openvdb::CoordBBox::createCube(origin, CoefficientBrick::kSide);
    nodes.expand(1);
    nodes = nodesInBand(values, nodes, band);
    if (nodes.empty()) return kWholeBrick;
    // A search ends up to a voxel from places whose nearest node is in the band: voxel v reaches
    // from node v to the next.
    openvdb::CoordBBox voxels(nodes.min() - origin - openvdb::Coord(2),
                              nodes.max() - origin + openvdb::Coord(1));
    voxels.intersect(kWholeBrick);
    const bool isWorth = !voxels.empty() && static_cast<double>(voxels.volume()) <
                                                kNearlyWhole * double(kWholeBrick.volume());
    return isWorth ? voxels : kWholeBrick;
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
    const std::size_t nodes = kSide + kernel.width(), pitch = kSide + kernel.paddedWidth();
    return nodes * nodes * pitch * sizeof(float) + sizeof(CoefficientBrick);
}

CoefficientBrick::CoefficientBrick(const openvdb::FloatGrid& grid, const openvdb::Coord& brick,
                                   const InterpolationDesign& design,
                                   const std::optional<DensityBand>& mostlyRead,
                                   BrickScratch& scratch) {
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> values(grid.tree());
    const openvdb::Coord origin(brick[0] * kSide, brick[1] * kSide, brick[2] * kSide);
    const int reach = design.reach();
    const auto haloOf = [&](const openvdb::CoordBBox& voxels) {
        const openvdb::Coord first =
            origin + voxels.min().offsetBy(firstNode(design.kernel) - reach);
        return openvdb::CoordBBox(
            first, first + voxels.dim().offsetBy(design.kernel.width() + 2 * reach - 1));
    };

    // In the middle of large tiles nothing is to be copied: they may fill very many bricks.
    if (const auto constant = valueOfLargeTiles(values, haloOf(kWholeBrick))) {
        mBegin = kWholeBrick.min().asVec3d();
        mEnd = kWholeBrick.max().offsetBy(1).asVec3d();
        mConstant = *constant;
        return;
    }

    const openvdb::CoordBBox voxels =
        mostlyRead ? mostlyReadVoxels(values, origin, *mostlyRead) : kWholeBrick;
    mBegin = voxels.min().asVec3d();
    mEnd = voxels.max().offsetBy(1).asVec3d();

    // Copy the lattice under them and a halo.
    const openvdb::Coord nodes = voxels.dim().offsetBy(design.kernel.width());
    const openvdb::CoordBBox halo = haloOf(voxels);
    const std::size_t rowLength = halo.dim()[2], plane = rowLength * halo.dim()[1];
    scratch.lattice.resize(plane * halo.dim()[0]);
    if (copyBox(values, halo, scratch.lattice.data(), plane, rowLength)) {
        mConstant = scratch.lattice.front();
        return;
    }

    // Convolve along x, then y, then z; each pass leaves fewer planes, rows, or nodes. The
    // kernel's last nodes along z, which lie in the padding, have no weight and are 0.
    const std::vector<float> single(design.prefilter.begin(), design.prefilter.end());
    const auto pass = [&](const float* in, float* out, const ConvolutionRows& rows,
                          std::size_t stride) {
        if (design.singlePrecision) {
            convolveSingle(in, out, rows, stride, single);
        } else {
            convolve(in, out, rows, stride, design.prefilter);
        }
    };
    mRows = nodes[1];
    mPitch = voxels.dim()[2] + design.kernel.paddedWidth();
    const std::size_t planes = nodes[0], rows = nodes[1], length = nodes[2], pitch = mPitch;
    scratch.filtered.resize(planes * plane);
    pass(scratch.lattice.data(), scratch.filtered.data(), {1, planes * plane, 0, 0}, plane);
    pass(scratch.filtered.data(), scratch.lattice.data(),
         {planes, rows * rowLength, plane, rows * rowLength}, rowLength);
    mCoefficients = std::make_unique_for_overwrite<float[]>(planes * rows * pitch);
    pass(scratch.lattice.data(), mCoefficients.get(), {planes * rows, length, rowLength, pitch}, 1);
    for (std::size_t row = 0; row < planes * rows; ++row) {
        std::fill_n(&mCoefficients[row * pitch + length], pitch - length, 0.0F);
    }
}

double CoefficientBrick::value(const SpreadingKernel& kernel, const openvdb::Vec3d& local) const {
    return !mCoefficients ? mConstant : sumValue(nodes(), kernel, local - mBegin);
}

DensityAt CoefficientBrick::evaluate(const SpreadingKernel& kernel,
                                     const openvdb::Vec3d& local) const {
    if (!mCoefficients) return {mConstant, {0, 0, 0}};
    return sumGradient(nodes(), kernel, local - mBegin);
}

DensityExpansion CoefficientBrick::expand(const SpreadingKernel& kernel,
                                          const openvdb::Vec3d& local) const {
    if (!mCoefficients) return {mConstant, {0, 0, 0}, openvdb::Mat3d::zero()};
    return sumHessian(nodes(), kernel, local - mBegin);
}

}  // namespace bandvox
