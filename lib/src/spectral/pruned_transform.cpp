#include "spectral/complex_fft.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/spectral/pruned_transform.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

// e^{2πi numerator/denominator}; the fraction is reduced first, so that the angle stays exact.
template <typename Real>
std::complex<Real> rootOfUnity(std::int64_t numerator, std::int64_t denominator) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(numerator % denominator) / denominator;
    return {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))};
}

void countTransforms(OperationCount* count, double transforms, int points) {
    if (count) count->multiplications += transforms * points * std::log2(points);
}

void countProducts(OperationCount* count, double products) {
    if (count) count->multiplications += products;
}

// The operators of std::complex look for infinities; these do not.
template <typename Real>
std::complex<Real> product(const std::complex<Real>& a, const std::complex<Real>& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// to[b] = factor·from[b], or to[b] += factor·from[b].
template <bool add, typename Real>
void multiplyRow(const std::complex<Real>& factor, const std::complex<Real>* from,
                 std::complex<Real>* to, int batch) {
    for (int b = 0; b < batch; ++b) {
        const std::complex<Real> value = product(factor, from[b]);
        to[b] = add ? to[b] + value : value;
    }
}

// An array for at least `size` numbers.
template <typename Complex>
Complex* reserve(std::vector<Complex>& scratch, std::size_t size) {
    if (scratch.size() < size) scratch.resize(size);
    return scratch.data();
}

}  // namespace

template <typename Real>
LowFrequencyTransform<Real>::LowFrequencyTransform(int samples, int frequencies)
    : mSamples(samples), mFrequencies(frequencies) {
    if (frequencies < 1 || samples < frequencies || samples % frequencies != 0) {
        throw Error(ErrorKind::Usage, std::to_string(frequencies) + " frequencies are asked of " +
                                          std::to_string(samples) +
                                          " samples; the number of samples must be a multiple of "
                                          "the number of frequencies, and both positive");
    }
    const int parts = samples / frequencies;
    requireMemory(static_cast<double>(samples) * sizeof(Complex),
                  ("a transform of R = " + std::to_string(samples) + " samples").c_str());
    mTwiddles.reserve(samples);
    for (std::int64_t p = 0; p < parts; ++p) {
        for (int k = 0; k < frequencies; ++k) {
            mTwiddles.push_back(rootOfUnity<Real>(-p * signedFrequency(k, frequencies), samples));
        }
    }
}

template <typename Real>
void LowFrequencyTransform<Real>::operator()(SignalBatch<const Complex> samples,
                                             SignalBatch<Complex> spectrum, int batch,
                                             std::vector<Complex>& scratch,
                                             OperationCount* count) const {
    // Every (R/N)-th sample makes a signal of N points, whose transforms repeat every N
    // frequencies; turned by their offsets they add up.
    const int n = mFrequencies;
    const int parts = mSamples / n;
    Complex* part = reserve(scratch, static_cast<std::size_t>(n) * batch);
    const auto& fft = ComplexFft<Real>::get(n, batch, FftDirection::Forward,
                                            {parts * samples.stride, 1}, {batch, 1});
    for (int p = 0; p < parts; ++p) {
        fft(samples.data + p * samples.stride, part);
        for (int k = 0; k < n; ++k) {
            Complex* to = spectrum.data + k * spectrum.stride;
            const Complex* from = part + static_cast<std::size_t>(k) * batch;
            if (p == 0) {
                std::copy_n(from, batch, to);
            } else {
                multiplyRow<true>(mTwiddles[static_cast<std::size_t>(p) * n + k], from, to, batch);
            }
        }
    }
    countTransforms(count, static_cast<double>(parts) * batch, n);
    countProducts(count, static_cast<double>(parts - 1) * n * batch);
}

template <typename Real>
void LowFrequencyTransform<Real>::pair(const Real* first, const Real* second,
                                       Complex* firstSpectrum, Complex* secondSpectrum,
                                       std::vector<Complex>& scratch, OperationCount* count) const {
    const int n = mFrequencies;
    const int parts = mSamples / n;
    Complex* packed = reserve(scratch, 2 * static_cast<std::size_t>(mSamples) + n);
    Complex* transformed = packed + mSamples;
    Complex* sum = transformed + mSamples;
    for (int j = 0; j < mSamples; ++j) packed[j] = Complex(first[j], second[j]);

    // As above, with the parts as the batch.
    ComplexFft<Real>::get(n, parts, FftDirection::Forward, {parts, 1}, {1, n})(packed, transformed);
    std::copy_n(transformed, n, sum);
    for (int p = 1; p < parts; ++p) {
        const Complex* twiddles = mTwiddles.data() + static_cast<std::size_t>(p) * n;
        const Complex* part = transformed + static_cast<std::size_t>(p) * n;
        for (int k = 0; k < n; ++k) sum[k] += product(twiddles[k], part[k]);
    }
    countTransforms(count, parts, n);
    countProducts(count, static_cast<double>(parts - 1) * n);

    // Take the two apart: with Z = A + iB, A(k) = (Z(k) + Z*(-k)) / 2, B(k) = (Z(k) - Z*(-k)) / 2i.
    // At Nyquist, which stands for -N/2, +N/2 is not at hand: it takes a sum of its own.
    const Real half(0.5);
    for (int k = 0; 2 * k <= n; ++k) {
        Complex mirrored = std::conj(sum[k == 0 ? 0 : n - k]);
        if (2 * k == n) {
            mirrored = Complex(0);
            for (int p = 0; p < parts; ++p) {
                mirrored +=
                    std::conj(product(std::conj(mTwiddles[static_cast<std::size_t>(p) * n + k]),
                                      transformed[static_cast<std::size_t>(p) * n + k]));
            }
        }
        const Complex even = (sum[k] + mirrored) * half;
        const Complex odd = (sum[k] - mirrored) * half;
        firstSpectrum[k] = even;
        secondSpectrum[k] = Complex(odd.imag(), -odd.real());
    }
}

template <typename Real>
PhaseTransform<Real>::PhaseTransform(int frequencies, int magnification)
    : mFrequencies(frequencies), mMagnification(magnification) {
    const std::int64_t places = static_cast<std::int64_t>(frequencies) * magnification;
    if (frequencies < 1 || magnification < 1 || places > std::numeric_limits<int>::max()) {
        throw Error(ErrorKind::Usage, "an interpolation of " + std::to_string(frequencies) +
                                          " frequencies is asked to magnify by " +
                                          std::to_string(magnification) +
                                          "; both must be positive and their product below 2^31");
    }
    requireMemory(static_cast<double>(places) * sizeof(Complex),
                  ("a transform to M = LN = " + std::to_string(places) + " places").c_str());
    mTwiddles.reserve(static_cast<std::size_t>(places));
    for (std::int64_t s = 0; s < magnification; ++s) {
        for (int k = 0; k < frequencies; ++k) {
            mTwiddles.push_back(rootOfUnity<Real>(s * signedFrequency(k, frequencies), places));
        }
    }
}

template <typename Real>
std::span<const std::complex<Real>> PhaseTransform<Real>::twiddles(int phase) const {
    return {mTwiddles.data() + static_cast<std::size_t>(phase) * mFrequencies,
            static_cast<std::size_t>(mFrequencies)};
}

template <typename Real>
void PhaseTransform<Real>::operator()(int phase, SignalBatch<const Complex> spectrum,
                                      SignalBatch<Complex> values, int batch,
                                      std::vector<Complex>& scratch, OperationCount* count) const {
    const int n = mFrequencies;
    const std::span<const Complex> turn = twiddles(phase);
    const Real scale = Real(1) / static_cast<Real>(n);
    Complex* turned = reserve(scratch, static_cast<std::size_t>(n) * batch);
    for (int k = 0; k < n; ++k) {
        multiplyRow<false>(turn[k] * scale, spectrum.data + k * spectrum.stride,
                           turned + static_cast<std::size_t>(k) * batch, batch);
    }
    ComplexFft<Real>::get(n, batch, FftDirection::Backward, {batch, 1}, {values.stride, 1})(
        turned, values.data);
    countTransforms(count, batch, n);
    countProducts(count, static_cast<double>(n) * batch);
}

template <typename Real>
SubsetTransform<Real>::SubsetTransform(const PhaseTransform<Real>& phases) : mPhases(phases) {
    const int n = phases.frequencies();
    for (int d = 1; d <= n; ++d) {
        if (n % d == 0) mDivisors.push_back(d);
    }
    mRoots.reserve(n);
    for (int j = 0; j < n; ++j) mRoots.push_back(rootOfUnity<Real>(j, n));
}

// The divisor X of N for which N log X + (N/X - 1) W is least.
template <typename Real>
int SubsetTransform<Real>::chooseDivisor(std::size_t places) const {
    const int n = mPhases.frequencies();
    const auto cost = [&](int x) {
        return n * std::log2(x) + (static_cast<double>(n) / x - 1) * static_cast<double>(places);
    };
    return *std::min_element(mDivisors.begin(), mDivisors.end(),
                             [&](int a, int b) { return cost(a) < cost(b); });
}

template <typename Real>
void SubsetTransform<Real>::operator()(int phase, std::span<const int> places,
                                       SignalBatch<const Complex> spectrum,
                                       SignalBatch<Complex> values, int batch,
                                       std::vector<Complex>& scratch, OperationCount* count) const {
    if (places.empty()) return;
    const int n = mPhases.frequencies();
    const int x = chooseDivisor(places.size());
    const int parts = n / x;
    const Real scale = Real(1) / static_cast<Real>(n);
    const std::size_t size = static_cast<std::size_t>(n) * batch;
    Complex* turned = reserve(scratch, 2 * size);
    Complex* transformed = turned + size;

    // Every (N/X)-th frequency makes a spectrum of X points, whose values repeat every X places.
    const std::span<const Complex> turn = mPhases.twiddles(phase);
    for (int k = 0; k < n; ++k) {
        multiplyRow<false>(turn[k] * scale, spectrum.data + k * spectrum.stride,
                           turned + static_cast<std::size_t>(k) * batch, batch);
    }
    const auto& fft =
        ComplexFft<Real>::get(x, batch, FftDirection::Backward,
                              {static_cast<std::ptrdiff_t>(parts) * batch, 1}, {batch, 1});
    for (int a = 0; a < parts; ++a) {
        fft(turned + static_cast<std::size_t>(a) * batch,
            transformed + static_cast<std::size_t>(a) * x * batch);
    }

    // Turned by their offsets they add up, at the places that are asked for.
    for (std::size_t i = 0; i < places.size(); ++i) {
        const int r = places[i];
        Complex* to = values.data + static_cast<std::ptrdiff_t>(i) * values.stride;
        const Complex* from = transformed + static_cast<std::size_t>(r % x) * batch;
        std::copy_n(from, batch, to);
        for (int a = 1; a < parts; ++a) {
            const auto root = static_cast<std::size_t>(static_cast<std::int64_t>(a) * r % n);
            multiplyRow<true>(mRoots[root], from + static_cast<std::size_t>(a) * x * batch, to,
                              batch);
        }
    }
    countTransforms(count, static_cast<double>(parts) * batch, x);
    countProducts(count, (n + (parts - 1.0) * static_cast<double>(places.size())) * batch);
}

template class LowFrequencyTransform<float>;
template class LowFrequencyTransform<double>;
template class PhaseTransform<float>;
template class PhaseTransform<double>;
template class SubsetTransform<float>;
template class SubsetTransform<double>;

}  // namespace bandvox
