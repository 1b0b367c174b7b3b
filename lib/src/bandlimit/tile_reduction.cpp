#include "bandlimit/tile_reduction.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

// Rows hold the frequencies up to Nyquist, and do not all begin in the same sets of a cache.
int strideOf(int side) {
    const int padded = (side / 2 + 1 + 3) / 4 * 4;
    return padded % 8 == 0 ? padded + 4 : padded;
}

}  // namespace

TileReduction::TileReduction(const TileGeometry& geometry, int oversample)
    : mGeometry(geometry),
      mRowStride(strideOf(geometry.side)),
      mRows(geometry.side * oversample, geometry.side),
      mReduce(geometry.side * oversample, geometry.side),
      mFft(RealFft3::get(geometry.side, 0, 0, geometry.interior)) {
    // Tabulate the filter on one octant. An unscaled inverse transform of T³ frequencies of R³
    // samples is R³ times the mean.
    const int half = geometry.side / 2;
    const double scale = std::pow(samples(), -3);
    mTransfer.reserve(static_cast<std::size_t>(half) * half * half);
    for (int x = 0; x < half; ++x) {
        for (int y = 0; y < half; ++y) {
            for (int z = 0; z < half; ++z) {
                const double k =
                    std::sqrt(static_cast<double>(x * x + y * y + z * z)) / geometry.side;
                mTransfer.push_back(static_cast<float>(scale * geometry.filter(k)));
            }
        }
    }
}

double TileReduction::memory() const {
    const double rows = static_cast<double>(samples()) * (mGeometry.side + 1) + 2.0 * samples() +
                        static_cast<double>(mGeometry.side);
    return rows * mRowStride * sizeof(std::complex<float>);
}

TileSamples::TileSamples(const TileReduction& reduction)
    : mReduction(reduction),
      mPlaneSize(static_cast<std::size_t>(reduction.mGeometry.side) * reduction.mRowStride),
      mRows(static_cast<std::size_t>(reduction.samples()) * reduction.mRowStride),
      mPlanes(reduction.samples() * mPlaneSize) {}

void TileSamples::begin() {
    mPlaneValue = {};
    mTileValue = {};
}

// Step I of figure 12, which reduces a row.
void TileSamples::addRows(int y, const float* first, const float* second) {
    Complex* spectrum = mRows.data() + static_cast<std::size_t>(y) * mReduction.mRowStride;
    const bool isOne =
        mReduction.mRows.pair(first, second, spectrum, spectrum + mReduction.mRowStride, mScratch);
    mPlaneValue.see(first[0]);
    mPlaneValue.isOne = mPlaneValue.isOne && isOne;
}

void TileSamples::addConstantRow(int y, float value) {
    mReduction.mRows.constant(value,
                              mRows.data() + static_cast<std::size_t>(y) * mReduction.mRowStride);
    mPlaneValue.see(value);
}

// Step II, which reduces the plane along y.
void TileSamples::finishPlane(int x) {
    const OneValue value = mPlaneValue;
    mPlaneValue = {};
    if (value.isOne) return addConstantPlane(x, value.first);
    mTileValue.isOne = false;
    const int stride = mReduction.mRowStride;
    mReduction.mReduce({mRows.data(), stride}, {plane(x), stride}, mReduction.mGeometry.side / 2,
                       mScratch);
}

void TileSamples::addConstantPlane(int x, float value) {
    std::fill_n(plane(x), mPlaneSize, Complex(0));
    const auto samples = static_cast<float>(mReduction.samples());
    *plane(x) = value * samples * samples;
    mTileValue.see(value);
}

std::optional<float> TileSamples::constant() const {
    return mTileValue.isOne ? std::optional(mTileValue.first) : std::nullopt;
}

// Step III, which reduces along x, and the filter. Frequencies at Nyquist have no sign and become
// 0.
void TileSamples::filter(float* buffer) {
    const int side = mReduction.mGeometry.side;
    const int half = side / 2;
    const RealFft3& fft = mReduction.mFft;
    const auto rowStride = static_cast<std::size_t>(fft.zStride()) / 2;
    const std::size_t planeStride = fft.yCount() * rowStride;
    auto* spectrum = reinterpret_cast<Complex*>(buffer);
    for (int y = 0; y < side; ++y) {
        Complex* row = spectrum + y * rowStride;
        if (y != half) {
            mReduction.mReduce(
                {mPlanes.data() + static_cast<std::size_t>(y) * mReduction.mRowStride,
                 static_cast<std::ptrdiff_t>(mPlaneSize)},
                {row, static_cast<std::ptrdiff_t>(planeStride)}, half, mScratch);
        }
        multiplyRow(y, row, planeStride);
    }
    fft.inverse(buffer, mReduction.mGeometry.halo);
}

void TileSamples::multiplyRow(int y, Complex* row, std::size_t planeStride) const {
    const int side = mReduction.mGeometry.side;
    const int half = side / 2;
    const auto folded = [&](int index) { return index <= half ? index : side - index; };
    for (int x = 0; x < side; ++x, row += planeStride) {
        row[half] = 0;
        if (x == half || y == half) {
            std::fill_n(row, half, Complex(0));
            continue;
        }
        const float* transfer = mReduction.mTransfer.data() +
                                (static_cast<std::size_t>(folded(x)) * half + folded(y)) * half;
        for (int z = 0; z < half; ++z) row[z] *= transfer[z];
    }
}

}  // namespace bandvox
