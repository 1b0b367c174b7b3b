#include "bandlimit/tile_filter.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace bandvox {

namespace {

// More samples of a tile than this are summed up so many at a time.
constexpr std::size_t kFewSamples = 1 << 17;
constexpr std::size_t kSamplesTogether = 2048;

// The factor along x of a difference of neighbours, (1 - e^{-2πik}) / (2πik), or 1.
std::vector<std::complex<float>> factorsAlongX(int side, TileFilter::Output output) {
    std::vector<std::complex<float>> factors;
    for (int i = 0; i < side; ++i) {
        const double k = static_cast<double>(i <= side / 2 ? i : i - side) / side;
        const std::complex<double> turn(0, 2 * std::numbers::pi * k);
        const bool isOne = i == 0 || output == TileFilter::Output::Values;
        factors.emplace_back(isOne ? 1.0 : (1.0 - std::exp(-turn)) / turn);
    }
    return factors;
}

// H(|k|) over the kernel's transform along each axis; 0 at Nyquist, where frequencies have no sign.
PackedFilter transferOf(const RealFft3& fft, const TilePlan& plan, TileFilter::Output output) {
    const int side = plan.side, half = side / 2;
    std::vector<double> kernel;
    for (int i = 0; i <= half; ++i) {
        kernel.push_back(plan.kernel.transform(static_cast<double>(i) / side));
    }
    // A packed transform and its inverse make side³ / 2 of what was there.
    const double scale = 2 / std::pow(side, 3);
    const auto transfer = [&](int x, int y, int z) {
        if (std::max({x, y, z}) == half) return 0.0;
        const double k = std::sqrt(static_cast<double>(x * x + y * y + z * z)) / side;
        return scale * plan.filter(k) / (kernel[x] * kernel[y] * kernel[z]);
    };
    return {fft, transfer, true, factorsAlongX(side, output)};
}

}  // namespace

TileFilter::TileFilter(const TilePlan& plan, Output output)
    : mPlan(plan),
      mShift((plan.kernel.width() + 1) / 2),
      mMargin(mShift + (plan.kernel.width() + 1) / 2 + 1),
      mFirst(mShift + plan.halo),
      mFft(RealFft3::get(plan.side, mMargin, mShift + plan.kernel.paddedWidth() + 1,
                         plan.interior + 1, SpectrumLayout::Packed)),
      mTransfer(transferOf(mFft, plan, output)) {}

openvdb::Vec3d TileFilter::regionOffset() const {
    // Along x a difference at the first voxel reaches one voxel further back.
    return openvdb::Vec3d(-mPlan.halo - 1, -mPlan.halo, -mPlan.halo);
}

void TileFilter::spread(std::span<const SurfaceSample> samples, float* buffer) const {
    const auto offset = static_cast<float>(mShift);
    const SpreadLattice lattice{buffer, mFft.yCount(), mFft.zStride()};
    if (samples.size() <= kFewSamples) {
        spreadSamples(samples, offset, mPlan.kernel, lattice);
        return;
    }
    // Of millions of samples, each is too little to be added to the sum of all others in single
    // precision: sum up some, then their sums.
    std::vector<float> part(mFft.bufferSize(), 0.0F);
    while (!samples.empty()) {
        const auto some = samples.first(std::min(samples.size(), kSamplesTogether));
        samples = samples.subspan(some.size());
        spreadSamples(some, offset, mPlan.kernel, {part.data(), lattice.yCount, lattice.zStride});
        moveNodes(nodesUnder(some), part.data(), buffer);
    }
}

void TileFilter::spread(std::span<const PairedSample> samples, float* scratch,
                        const std::array<float*, 2>& buffers) const {
    const auto offset = static_cast<float>(mShift);
    const std::size_t together = samples.size() <= kFewSamples ? samples.size() : kSamplesTogether;
    while (!samples.empty()) {
        const auto some = samples.first(std::min(samples.size(), together));
        samples = samples.subspan(some.size());
        spreadSamples(some, offset, mPlan.kernel, {scratch, mFft.yCount(), mFft.zStride()});
        movePairs(nodesUnder(some), scratch, buffers);
    }
}

// The nodes that samples may have been spread to.
template <typename Sample>
openvdb::CoordBBox TileFilter::nodesUnder(std::span<const Sample> samples) const {
    openvdb::math::BBox<openvdb::Vec3f> box;
    for (const Sample& sample : samples) box.expand(sample.position);
    const int reach = mPlan.kernel.paddedWidth() + 1;
    const openvdb::Coord count(mFft.xCount(), mFft.yCount(), mFft.zStride());
    openvdb::CoordBBox nodes;
    for (int axis = 0; axis < 3; ++axis) {
        nodes.min()[axis] = std::max(static_cast<int>(box.min()[axis]) + mShift - reach, 0);
        nodes.max()[axis] =
            std::min(static_cast<int>(box.max()[axis]) + mShift + reach, count[axis] - 1);
    }
    return nodes;
}

// Adds what is in a part to the buffer, and leaves zeros there.
void TileFilter::moveNodes(const openvdb::CoordBBox& nodes, float* part, float* buffer) const {
    const int length = nodes.dim().z();
    for (int x = nodes.min().x(); x <= nodes.max().x(); ++x) {
        for (int y = nodes.min().y(); y <= nodes.max().y(); ++y) {
            const std::size_t row =
                (static_cast<std::size_t>(x) * mFft.yCount() + y) * mFft.zStride() +
                nodes.min().z();
            for (int z = 0; z < length; ++z) buffer[row + z] += part[row + z];
            std::fill_n(part + row, length, 0.0F);
        }
    }
}

// The same for pairs, each of the two to its own buffer.
void TileFilter::movePairs(const openvdb::CoordBBox& nodes, float* part,
                           const std::array<float*, 2>& buffers) const {
    const int length = nodes.dim().z();
    for (int x = nodes.min().x(); x <= nodes.max().x(); ++x) {
        for (int y = nodes.min().y(); y <= nodes.max().y(); ++y) {
            const std::size_t row =
                (static_cast<std::size_t>(x) * mFft.yCount() + y) * mFft.zStride() +
                nodes.min().z();
            float* pairs = part + 2 * row;
            for (int z = 0; z < length; ++z) {
                buffers[0][row + z] += pairs[2 * z];
                buffers[1][row + z] += pairs[2 * z + 1];
            }
            std::fill_n(pairs, 2 * length, 0.0F);
        }
    }
}

void TileFilter::apply(float* buffer) const {
    fold(buffer);
    mFft.forward(buffer);
    mTransfer.multiply(buffer);
    mFft.inverse(buffer, mFirst);
}

// The transform is periodic: what was spread beyond the cube belongs to its other side.
void TileFilter::fold(float* buffer) const {
    const int side = mPlan.side;
    const int zStride = mFft.zStride();
    const std::size_t plane = static_cast<std::size_t>(mFft.yCount()) * zStride;
    const auto addRow = [](float* to, const float* from, int length) {
        for (int i = 0; i < length; ++i) to[i] += from[i];
    };
    for (int x = side; x < mFft.xCount(); ++x) {
        addRow(buffer + (x - side) * plane, buffer + x * plane, static_cast<int>(plane));
    }
    for (int x = 0; x < side; ++x) {
        float* rows = buffer + x * plane;
        for (int y = side; y < mFft.yCount(); ++y) {
            addRow(rows + (y - side) * zStride, rows + y * zStride, zStride);
        }
        for (int y = 0; y < side; ++y) {
            float* row = rows + y * zStride;
            addRow(row, row + side, std::min(zStride - side, side));
        }
    }
}

}  // namespace bandvox
