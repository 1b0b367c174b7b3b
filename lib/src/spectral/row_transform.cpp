#include "spectral/row_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace bandvox {

namespace {

// With more steps the general transform is faster.
constexpr int kMostSteps = 12;

/// Where a row changes its value.
struct Steps {
    std::array<int, kMostSteps> at;  // f(at - 1) != f(at)
    int count = 0;                   // kMostSteps + 1 if there are more than fit
};

Steps findSteps(const float* row, int samples) {
    constexpr int kChunk = 32;  // what vector instructions compare at a time
    Steps steps;
    for (int begin = 1; begin < samples; begin += kChunk) {
        const int end = std::min(begin + kChunk, samples);
        int differences = 0;
        for (int i = begin; i < end; ++i) differences |= static_cast<int>(row[i] != row[i - 1]);
        if (differences == 0) continue;
        for (int i = begin; i < end; ++i) {
            if (row[i] == row[i - 1]) continue;
            if (steps.count == kMostSteps) {
                ++steps.count;
                return steps;
            }
            steps.at[steps.count++] = i;
        }
    }
    return steps;
}

}  // namespace

RowTransform::RowTransform(int samples, int frequencies)
    : mGeneral(samples, frequencies),
      mCount(frequencies / 2 + 1),
      mPrefixes(static_cast<std::size_t>(samples) * mCount) {
    for (int k = 0; k < mCount; ++k) {
        const std::int64_t frequency = signedFrequency(k, frequencies);
        std::complex<double> sum = 0;
        for (std::int64_t j = 0; j < samples; ++j) {
            mPrefixes[static_cast<std::size_t>(j) * mCount + k] = Complex(sum);
            const double turns = static_cast<double>(j * frequency % samples) / samples;
            sum += std::polar(1.0, -2 * std::numbers::pi * turns);
        }
    }
}

void RowTransform::constant(float value, Complex* spectrum) const {
    std::fill_n(spectrum, mCount, Complex(0));
    spectrum[0] = value * static_cast<float>(mGeneral.samples());
}

bool RowTransform::pair(const float* first, const float* second, Complex* firstSpectrum,
                        Complex* secondSpectrum, std::vector<Complex>& scratch) const {
    const int samples = mGeneral.samples();
    const Steps steps[] = {findSteps(first, samples), findSteps(second, samples)};
    if (std::max(steps[0].count, steps[1].count) > kMostSteps) {
        mGeneral.pair(first, second, firstSpectrum, secondSpectrum, scratch);
        return false;
    }
    const auto addUp = [&](const float* row, const Steps& found, Complex* spectrum) {
        constant(row[samples - 1], spectrum);
        for (int s = 0; s < found.count; ++s) {
            const int i = found.at[s];
            const float step = row[i - 1] - row[i];
            const Complex* prefix = mPrefixes.data() + static_cast<std::size_t>(i) * mCount;
            for (int k = 0; k < mCount; ++k) spectrum[k] += step * prefix[k];
        }
    };
    addUp(first, steps[0], firstSpectrum);
    addUp(second, steps[1], secondSpectrum);
    return steps[0].count == 0 && steps[1].count == 0 && first[0] == second[0];
}

}  // namespace bandvox
