#include "spectral/packed_filter.h"

#include "core/instruction_sets.h"
#include "spectral/packed_row.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

namespace bandvox {

namespace {

constexpr int kLargestSide = 512;

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
    turnedConjugates(a, n, mirroredA);
    turnedConjugates(b, n, mirroredB);
    mixRow(a, mirroredB, weightsOfA, n, factor);
    if (a != b) mixRow(b, mirroredA, weightsOfB, n, std::conj(factor));
}

}  // namespace

PackedFilter::PackedFilter(const RealFft3& fft, const Transfer& transfer, bool isEven,
                           std::vector<std::complex<float>> factors)
    : mFft(fft), mIsEven(isEven), mFactors(std::move(factors)) {
    const int n = fft.size(), half = n / 2;
    if (fft.layout() != SpectrumLayout::Packed || n > kLargestSide) {
        throw Error(ErrorKind::Runtime,
                    "a filter of " + std::to_string(n) +
                        " samples along an axis; expected a packed spectrum of at most " +
                        std::to_string(kLargestSide));
    }
    std::vector<double> sine, cosine;
    for (int z = 0; z < half; ++z) {
        sine.push_back(std::sin(2 * std::numbers::pi * z / n));
        cosine.push_back(std::cos(2 * std::numbers::pi * z / n));
    }
    const auto signedOf = [&](int i) { return i <= half ? i : i - n; };
    // -n/2 is n/2, and of what is even -x is x.
    const auto mirrored = [&](int i) { return isEven || i == half ? i : -i; };
    const auto turned = [&](int i) { return std::abs(i) == half ? -i : i; };
    const auto valueAt = [&](int x, int y, int z) {
        const bool hasSign = std::abs(x) != half && std::abs(y) != half && std::abs(z) != half;
        const double value = transfer(x, y, z);
        if (isEven || hasSign) return value;
        return 0.5 * (value + transfer(turned(x), turned(y), turned(z)));
    };
    const int count = isEven ? half + 1 : n;
    mWeights.resize(static_cast<std::size_t>(count) * count * n);
    parallelFor(count, [&](std::int64_t i) {
        float* weights = mWeights.data() + static_cast<std::size_t>(i) * count * n;
        const int x = signedOf(static_cast<int>(i));
        for (int j = 0; j < count; ++j, weights += n) {
            const int y = signedOf(j);
            for (int z = 0; z < half; ++z) {
                const double own = valueAt(x, y, z);
                const double other = valueAt(mirrored(x), mirrored(y), half - z);
                const double mean = 0.5 * (own + other), less = 0.5 * (own - other);
                weights[z] = static_cast<float>(mean - less * sine[z]);
                weights[half + z] = static_cast<float>(less * cosine[z]);
            }
        }
    });
}

const float* PackedFilter::weights(int x, int y) const {
    const int n = mFft.size(), half = n / 2;
    const auto place = [&](int i) { return mIsEven && i > half ? n - i : i; };
    const std::size_t count = mIsEven ? half + 1 : n;
    return mWeights.data() + (place(x) * count + place(y)) * n;
}

void PackedFilter::multiply(float* spectrum) const {
    const int n = mFft.size();
    std::array<float, 2 * kLargestSide> scratch;
    const auto row = [&](int x, int y) {
        return spectrum + (static_cast<std::size_t>(x) * mFft.yCount() + y) * mFft.zStride();
    };
    const auto mirrored = [&](int i) { return i == 0 ? 0 : n - i; };
    for (int x = 0; x <= n / 2; ++x) {
        const std::complex<float> factor = mFactors.empty() ? 1.0F : mFactors[x];
        const int otherX = mirrored(x);
        // Of planes that are their own mirrors, each pair of rows once.
        const int yEnd = x == otherX ? n / 2 + 1 : n;
        for (int y = 0; y < yEnd; ++y) {
            const int otherY = mirrored(y);
            mixRows(row(x, y), row(otherX, otherY), weights(x, y), weights(otherX, otherY), n,
                    factor, scratch.data());
        }
    }
}

}  // namespace bandvox
