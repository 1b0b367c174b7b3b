#pragma once

#include "spectral/fft.h"

#include <complex>
#include <functional>
#include <vector>

namespace bandvox {

/// Multiplies packed spectra of n³ real samples by a real transfer function T, T(-k) = T(k), and by
/// a factor D(k_x), D(-k_x) = conj D(k_x).
///
/// A packed spectrum Z holds frequency k = (x, y, z) together with k' = (-x, -y, n/2 - z). With the
/// mean P and half the difference M of T(k) and T(k'), and u = -i e^{-2πiz/n}, what they become is
///     D [(P + M Re u) Z(k) - i M Im u conj Z(k')],
/// so that nothing has to be unpacked.
class PackedFilter {
  public:
    /// What is asked for a frequency: cycles per n samples, with their signs. At n/2, where they
    /// have none, it is asked for both, and the mean is taken. From several threads.
    using Transfer = std::function<double(int x, int y, int z)>;

    /// For spectra that lie as in `fft`, of up to 512³ samples. `isEven`: T depends on the
    /// magnitudes of x, y and z alone, and is asked for no others. `factors`: D(x), 0 ≤ x < n; none
    /// for 1. D(n/2) is real, or T is 0 there. Throws Error(ErrorKind::Runtime) for another layout
    /// or more samples.
    PackedFilter(const RealFft3& fft, const Transfer& transfer, bool isEven,
                 std::vector<std::complex<float>> factors = {});

    void multiply(float* spectrum) const;

  private:
    const float* weights(int x, int y) const;

    const RealFft3& mFft;
    bool mIsEven;
    std::vector<std::complex<float>> mFactors;
    std::vector<float> mWeights;  // [x][y][2][n/2]: of Z(k), then of i conj Z(k')
};

}  // namespace bandvox
