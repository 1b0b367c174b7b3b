#pragma once

#include <bandvox/spectral/pruned_transform.h>

#include <complex>
#include <vector>

namespace bandvox {

/// Algorithm (a) for rows of real samples of which most are a few steps: a row through a solid is
/// 0 and 1 by turns. With f(-1) = 0 and E(i, k) = Σ_{j<i} e^{-2πijk/R},
///     F(k) = Σ_{j<R} f(j) e^{-2πijk/R} = f(R-1) E(R, k) + Σ_i (f(i-1) - f(i)) E(i, k),
/// where only steps add to the second sum: N products each, instead of R (1 + log N).
///
/// Immutable once built, and shared by all threads, each with a scratch array of its own.
class RowTransform {
  public:
    using Complex = std::complex<float>;

    /// Throws as LowFrequencyTransform.
    RowTransform(int samples, int frequencies);

    /// Writes F(k), 0 ≤ k ≤ N/2 (at Nyquist F(-N/2), as signedFrequency has it), of two rows of R
    /// samples. Returns true if all their samples are
    /// one value.
    bool pair(const float* first, const float* second, Complex* firstSpectrum,
              Complex* secondSpectrum, std::vector<Complex>& scratch) const;

    /// The same for a row of one value.
    void constant(float value, Complex* spectrum) const;

  private:
    LowFrequencyTransform<float> mGeneral;
    int mCount;                      // frequencies 0 ≤ k ≤ N/2
    std::vector<Complex> mPrefixes;  // [R][mCount]: E(i, k)
};

}  // namespace bandvox
