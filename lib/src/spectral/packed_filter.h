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
    /// What is asked for a frequency: cycles per n samples, with their signs; n/2 for Nyquist.
    using Transfer = std::function<double(int x, int y, int z)>;

    /// `isEven`: T depends on the magnitudes of x, y and z alone, and is asked for no others.
    /// `factors`: D(x), 0 ≤ x < n; none for 1.
    PackedFilter(int n, const Transfer& transfer, bool isEven,
                 std::vector<std::complex<float>> factors = {});

    /// Multiplies a spectrum that lies as in `fft`, whose layout is packed.
    void multiply(const RealFft3& fft, float* spectrum) const;

  private:
    const float* weights(int x, int y) const;

    int mSize;
    bool mIsEven;
    std::vector<std::complex<float>> mFactors;
    std::vector<float> mWeights;  // [x][y][2][n/2]: of Z(k), then of conj Z(k')
};

}  // namespace bandvox
