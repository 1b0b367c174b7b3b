#include "spectral/packed_filter.h"

#include "core/instruction_sets.h"
#include "spectral/packed_row.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace bandvox {

namespace {

// The weights are those of row[k] and mirrored[k], n/2 each.
[[gnu::always_inline]] inline void mixRow(float* row, const float* mirrored, const float* weights,
                                          int n, std::complex<float> factor) {
    const float* ofMirrored = weights + n / 2;
    const float factorRe = factor.real(), factorIm = factor.imag();
    for (int k = 0; k < n / 2; ++k) {
        const float re = weights[k] * row[2 * k] + ofMirrored[k] * mirrored[2 * k];
        const float im = weights[k] * row[2 * k + 1] + ofMirrored[k] * mirrored[2 * k + 1];
        row[2 * k] = re * factorRe - im * factorIm;
        row[2 * k + 1] = re * factorIm + im * factorRe;
    }
}

// Two rows, each of which holds the other's mirrored frequencies; they may be the same.
BANDVOX_FOR_EACH_INSTRUCTION_SET
void mixRows(float* a, float* b, const float* weightsOfA, const float* weightsOfB, int n,
             std::complex<float> factor, float* scratch) {
    float* mirroredA = scratch;
    float* mirroredB = scratch + n;
    mirrorPacked(a, n, mirroredA);
    mirrorPacked(b, n, mirroredB);
    mixRow(a, mirroredB, weightsOfA, n, factor);
    if (a != b) mixRow(b, mirroredA, weightsOfB, n, std::conj(factor));
}

}  // namespace

PackedFilter::PackedFilter(int n, const Transfer& transfer, bool isEven,
                           std::vector<std::complex<float>> factors)
    : mSize(n), mIsEven(isEven), mFactors(std::move(factors)) {
    const int half = n / 2;
    const int count = isEven ? half + 1 : n;
    const auto signedOf = [&](int i) { return i <= half ? i : i - n; };
    const auto mirroredOf = [&](int i) { return isEven || i == half ? i : -i; };
    mWeights.resize(static_cast<std::size_t>(count) * count * n);
    float* weights = mWeights.data();
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j, weights += n) {
            const int x = signedOf(i), y = signedOf(j);
            for (int z = 0; z < half; ++z) {
                const double own = transfer(x, y, z);
                const double other = transfer(mirroredOf(x), mirroredOf(y), half - z);
                const double mean = 0.5 * (own + other), less = 0.5 * (own - other);
                const double angle = 2 * std::numbers::pi * z / n;
                weights[z] = static_cast<float>(mean - less * std::sin(angle));
                weights[half + z] = static_cast<float>(less * std::cos(angle));
            }
        }
    }
}

const float* PackedFilter::weights(int x, int y) const {
    const int half = mSize / 2;
    const auto place = [&](int i) { return mIsEven && i > half ? mSize - i : i; };
    const std::size_t count = mIsEven ? half + 1 : mSize;
    return mWeights.data() + (place(x) * count + place(y)) * mSize;
}

void PackedFilter::multiply(const RealFft3& fft, float* spectrum) const {
    std::vector<float> scratch(2 * static_cast<std::size_t>(mSize));
    const auto row = [&](int x, int y) {
        return spectrum + (static_cast<std::size_t>(x) * fft.yCount() + y) * fft.zStride();
    };
    const auto mirrored = [&](int i) { return i == 0 ? 0 : mSize - i; };
    for (int x = 0; x <= mSize / 2; ++x) {
        const std::complex<float> factor = mFactors.empty() ? 1.0F : mFactors[x];
        const int otherX = mirrored(x);
        // Of planes that are their own mirrors, each pair of rows once.
        const int yEnd = x == otherX ? mSize / 2 + 1 : mSize;
        for (int y = 0; y < yEnd; ++y) {
            const int otherY = mirrored(y);
            mixRows(row(x, y), row(otherX, otherY), weights(x, y), weights(otherX, otherY), mSize,
                    factor, scratch.data());
        }
    }
}

}  // namespace bandvox
