#include "core/words.h"
#include "spectral/complex_fft.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/spectral/pruned_transform.h>
#include <bandvox/spectral/spectral_volume.h>

#include <cmath>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

constexpr int kHighestResolution = 4096;

// Rows of N/2 + 1 numbers are padded so that each begins on a multiple of 32 bytes.
int paddedHalf(int resolution) {
    return (resolution / 2 + 1 + 3) / 4 * 4;
}

void requireResolution(int resolution, int samples) {
    if (resolution < 2 || resolution > kHighestResolution || resolution % 2 != 0) {
        throw Error(ErrorKind::Usage, "a spectral volume of N = " + std::to_string(resolution) +
                                          " is asked for; N must be even, 2 to " +
                                          std::to_string(kHighestResolution));
    }
    if (samples < resolution || samples % resolution != 0) {
        throw Error(ErrorKind::Usage, "a spectral volume of N = " + std::to_string(resolution) +
                                          " is asked for from R = " + std::to_string(samples) +
                                          " samples along a side; R must be a multiple of N");
    }
}

}  // namespace

template <typename Real>
BasicSpectralVolume<Real>::BasicSpectralVolume(int resolution, int samples,
                                               const ExponentialFilter& filter,
                                               const SpectralDomain& domain)
    : mResolution(resolution),
      mSamples(samples),
      mFilter(filter),
      mDomain(domain),
      mRowStride(paddedHalf(resolution)) {
    requireResolution(resolution, samples);
    requireValid(filter);
    if (!(domain.side > 0) || !std::isfinite(domain.side)) {
        throw Error(ErrorKind::Usage, "the domain of a spectral volume has the side " +
                                          std::to_string(domain.side) + "; it must be positive");
    }
    // Beyond that places could not be told apart.
    constexpr double kFarthest = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(domain.origin[axis]) <= kFarthest * domain.side)) {
            throw Error(ErrorKind::Usage, "the domain of a spectral volume begins at " +
                                              inShort(domain.origin[axis]) + " and its side is " +
                                              inShort(domain.side) +
                                              "; it must begin within a thousand million sides");
        }
    }
    const std::size_t size = static_cast<std::size_t>(resolution) * resolution * mRowStride;
    requireMemory(static_cast<double>(size) * sizeof(Complex),
                  ("a spectral volume of N = " + std::to_string(resolution)).c_str());
    mData.resize(size);
}

template <typename Real>
std::complex<Real> BasicSpectralVolume<Real>::coefficient(int l, int m, int n) const {
    const auto index = [this](int k) { return k < 0 ? k + mResolution : k; };
    if (n < 0) {
        // At Nyquist, where -N/2 has no counterpart, all is 0.
        if (2 * n == -mResolution) return 0;
        return std::conj(row(index(-l) % mResolution, index(-m) % mResolution)[-n]);
    }
    return row(index(l), index(m))[n];
}

template <typename Real>
double BasicSpectralVolume<Real>::directValue(const openvdb::Vec3d& voxel) const {
    const int n = mResolution;
    double sum = 0;
    for (int l = 0; l < n; ++l) {
        for (int m = 0; m < n; ++m) {
            const double across =
                signedFrequency(l, n) * voxel.x() + signedFrequency(m, n) * voxel.y();
            const Complex* line = row(l, m);
            for (int k = 0; 2 * k < n; ++k) {
                const double angle = 2 * std::numbers::pi * (across + k * voxel.z()) / n;
                sum += (k == 0 ? 1 : 2) *
                       (line[k].real() * std::cos(angle) - line[k].imag() * std::sin(angle));
            }
        }
    }
    return sum / (static_cast<double>(n) * n * n);
}

template <typename Real>
openvdb::Vec3d BasicSpectralVolume<Real>::directGradient(const openvdb::Vec3d& voxel) const {
    const int n = mResolution;
    openvdb::Vec3d sum(0.0);
    for (int l = 0; l < n; ++l) {
        for (int m = 0; m < n; ++m) {
            openvdb::Vec3d frequency(signedFrequency(l, n), signedFrequency(m, n), 0);
            const Complex* line = row(l, m);
            for (int k = 0; 2 * k < n; ++k) {
                frequency.z() = k;
                const double angle = 2 * std::numbers::pi * frequency.dot(voxel) / n;
                sum -= frequency * ((k == 0 ? 1 : 2) * (line[k].real() * std::sin(angle) +
                                                        line[k].imag() * std::cos(angle)));
            }
        }
    }
    return sum * (2 * std::numbers::pi / n / (static_cast<double>(n) * n * n));
}

template <typename Real>
std::vector<Real> BasicSpectralVolume<Real>::lattice() const {
    const int n = mResolution;
    const std::size_t plane = static_cast<std::size_t>(n) * mRowStride;
    const double count = static_cast<double>(n) * n * n;
    requireMemory(static_cast<double>(mData.size()) * sizeof(Complex) + count * sizeof(Real),
                  ("a lattice of N = " + std::to_string(n)).c_str());
    std::vector<Complex> work(mData);

    // Along x, then in each plane along y and z.
    const auto& alongX = ComplexFft<Real>::get(n, mRowStride, FftDirection::Backward,
                                               {static_cast<std::ptrdiff_t>(plane), 1},
                                               {static_cast<std::ptrdiff_t>(plane), 1}, true);
    parallelFor(n, [&](std::int64_t m) {
        Complex* column = work.data() + m * mRowStride;
        alongX(column, column);
    });
    std::vector<Real> values(static_cast<std::size_t>(n) * n * n);
    const auto& alongY = ComplexFft<Real>::get(n, mRowStride, FftDirection::Backward,
                                               {mRowStride, 1}, {mRowStride, 1}, true);
    const auto& alongZ = HalfComplexFft<Real>::get(n, n, {1, mRowStride}, {1, n});
    const Real scale = Real(1) / (static_cast<Real>(n) * n * n);
    parallelFor(n, [&](std::int64_t x) {
        Complex* columns = work.data() + x * plane;
        Real* out = values.data() + static_cast<std::size_t>(x) * n * n;
        alongY(columns, columns);
        alongZ(columns, out);
        for (int i = 0; i < n * n; ++i) out[i] *= scale;
    });
    return values;
}

template class BasicSpectralVolume<float>;
template class BasicSpectralVolume<double>;

}  // namespace bandvox
