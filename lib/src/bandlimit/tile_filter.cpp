#include "bandlimit/tile_filter.h"

#include "bandlimit/spread_samples.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace bandvox {

TileFilter::TileFilter(const TilePlan& plan)
    : mPlan(plan),
      mShift((plan.kernel.width() + 1) / 2),
      mMargin(mShift + (plan.kernel.width() + 1) / 2 + 1),
      mFirst(mShift + plan.halo),
      mFft(RealFft3::get(plan.side, mMargin, mShift + plan.kernel.paddedWidth() + 1,
                         plan.interior + 1)) {
    const int side = plan.side;
    const int half = side / 2;

    // Tabulate the difference along x; k is signed.
    mDifference.resize(2 * side);
    for (int i = 0; i < side; ++i) {
        const double k = static_cast<double>(i <= half ? i : i - side) / side;
        const std::complex<double> turn(0, 2 * std::numbers::pi * k);
        const std::complex<double> d = i == 0 ? 1.0 : (1.0 - std::exp(-turn)) / turn;
        mDifference[2 * i] = static_cast<float>(d.real());
        mDifference[2 * i + 1] = static_cast<float>(d.imag());
    }

    // Tabulate the transfer function over the kernel's transform, on one octant.
    const auto frequency = [side](int i) { return static_cast<double>(i) / side; };
    const auto isNyquist = [side](int i) { return 2 * i == side; };
    std::vector<double> kernel(half + 1);
    for (int i = 0; i <= half; ++i) kernel[i] = plan.kernel.transform(frequency(i));
    const double scale = 1.0 / (static_cast<double>(side) * side * side);
    mTransfer.reserve(static_cast<std::size_t>(half + 1) * (half + 1) * (half + 1));
    for (int x = 0; x <= half; ++x) {
        for (int y = 0; y <= half; ++y) {
            for (int z = 0; z <= half; ++z) {
                const double k = std::sqrt(static_cast<double>(x * x + y * y + z * z)) / side;
                const bool zero = isNyquist(x) || isNyquist(y) || isNyquist(z);
                const double value =
                    zero ? 0 : scale * plan.filter(k) / (kernel[x] * kernel[y] * kernel[z]);
                mTransfer.push_back(static_cast<float>(value));
            }
        }
    }
}

openvdb::Vec3d TileFilter::regionOffset() const {
    // Along x a difference at the first voxel reaches one voxel further back.
    return openvdb::Vec3d(-mPlan.halo - 1, -mPlan.halo, -mPlan.halo);
}

void TileFilter::spread(std::span<const SurfaceSample> samples, float* buffer) const {
    spreadSamples(samples, static_cast<float>(mShift), mPlan.kernel,
                  {buffer, mFft.yCount(), mFft.zStride()});
}

void TileFilter::apply(float* buffer) const {
    fold(buffer);
    mFft.forward(buffer);
    multiply(buffer);
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

void TileFilter::multiply(float* buffer) const {
    const int side = mPlan.side;
    const int half = side / 2;
    const int count = half + 1;
    for (int x = 0; x < side; ++x) {
        const float dr = mDifference[2 * x];
        const float di = mDifference[2 * x + 1];
        const int ax = x <= half ? x : side - x;
        for (int y = 0; y < side; ++y) {
            const int ay = y <= half ? y : side - y;
            const float* transfer =
                mTransfer.data() + (static_cast<std::size_t>(ax) * count + ay) * count;
            float* row =
                buffer + (static_cast<std::size_t>(x) * mFft.yCount() + y) * mFft.zStride();
            for (int z = 0; z < count; ++z) {
                const float re = row[2 * z];
                const float im = row[2 * z + 1];
                row[2 * z] = transfer[z] * (re * dr - im * di);
                row[2 * z + 1] = transfer[z] * (re * di + im * dr);
            }
        }
    }
}

}  // namespace bandvox
