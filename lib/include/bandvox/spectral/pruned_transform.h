#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

// Transforms of which only a part is wanted, each by transforms of that part's size.
//
// N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), section 5, algorithms
// (a), (b) and (c). Frequencies are stored in the order of a transform of N points; index k
// stands for the signed frequency k if 2k < N, else k - N (signedFrequency).
//
// All of them work on `batch` signals side by side: point i of signal b lies at
// data[i·stride + b]. They are immutable once built, made for `float` and `double`, and may be
// used by many threads, each with a scratch array of its own.
namespace bandvox {

/// How many complex multiplications were carried out. A transform of n points counts as
/// n·log2(n), as in the paper, though FFTW needs fewer.
struct OperationCount {
    double multiplications = 0;
};

/// The frequency, -n/2 ≤ k < n/2, that index k of a transform of n points stands for.
constexpr int signedFrequency(int index, int n) {
    return 2 * index < n ? index : index - n;
}

/// Signals side by side: element i of signal b at data[i·stride + b]; `stride` ≥ the batch.
template <typename Value>
struct SignalBatch {
    operator SignalBatch<const Value>() const { return {data, stride}; }

    Value* data;
    std::ptrdiff_t stride;
};

/// Algorithm (a): the N lowest frequencies of R samples,
///     F(k) = Σ_{j<R} f(j) e^{-2πi jk/R}, k signed,
/// from R/N transforms of N points and R multiplications: R (1 + log N).
template <typename Real>
class LowFrequencyTransform {
  public:
    using Complex = std::complex<Real>;

    /// Throws Error(ErrorKind::Usage) unless 1 ≤ N ≤ R and N divides R.
    LowFrequencyTransform(int samples, int frequencies);

    int samples() const { return mSamples; }
    int frequencies() const { return mFrequencies; }

    /// `samples` is [R][batch], `spectrum` [N][batch]; they may not overlap.
    void operator()(SignalBatch<const Complex> samples, SignalBatch<Complex> spectrum, int batch,
                    std::vector<Complex>& scratch, OperationCount* count = nullptr) const;

    /// Two real signals of R samples at once, as the parts of a complex one. Writes their
    /// frequencies 0 ≤ k ≤ N/2: all that real signals have, for F(-k) is the conjugate of F(k).
    void pair(const Real* first, const Real* second, Complex* firstSpectrum,
              Complex* secondSpectrum, std::vector<Complex>& scratch,
              OperationCount* count = nullptr) const;

  private:
    int mSamples, mFrequencies;
    std::vector<Complex> mTwiddles;  // [R/N][N]: e^{-2πi kp/R}
};

/// Algorithm (b): band-limited interpolation at the places s + rL, r < N, of M = LN for one
/// phase s < L,
///     f(s + rL) = (1/N) Σ_k F(k) e^{2πi k(s + rL)/M}, k signed,
/// which the paper calls IFFT_N(s, F): N (1 + log N), and M (1 + log N) for all phases. The
/// array of M frequencies, most of them 0, is never made.
template <typename Real>
class PhaseTransform {
  public:
    using Complex = std::complex<Real>;

    /// Throws Error(ErrorKind::Usage) unless N, L ≥ 1 and LN < 2^31.
    PhaseTransform(int frequencies, int magnification);

    int frequencies() const { return mFrequencies; }
    int magnification() const { return mMagnification; }

    /// `spectrum` and `values` are [N][batch]; they may not overlap. 0 ≤ phase < L.
    void operator()(int phase, SignalBatch<const Complex> spectrum, SignalBatch<Complex> values,
                    int batch, std::vector<Complex>& scratch,
                    OperationCount* count = nullptr) const;

    /// e^{2πi ks/M} of each frequency, [N], for one phase s.
    std::span<const Complex> twiddles(int phase) const;

  private:
    int mFrequencies, mMagnification;
    std::vector<Complex> mTwiddles;  // [L][N]
};

/// Algorithm (c): the same at some of the places only. For W places r of one phase,
/// N (1 + log X) + (N/X - 1) W with the best divisor X of N; where W is one, X = W gives the
/// paper's N (1 + log W) + N - W. The places need not be next to each other.
template <typename Real>
class SubsetTransform {
  public:
    using Complex = std::complex<Real>;

    /// `phases` gives N and L, and has to outlive this object.
    explicit SubsetTransform(const PhaseTransform<Real>& phases);

    /// values[i] is f(s + rL) for r = places[i]; `spectrum` is [N][batch], `values` [W][batch].
    /// 0 ≤ places[i] < N.
    void operator()(int phase, std::span<const int> places, SignalBatch<const Complex> spectrum,
                    SignalBatch<Complex> values, int batch, std::vector<Complex>& scratch,
                    OperationCount* count = nullptr) const;

  private:
    int chooseDivisor(std::size_t places) const;

    const PhaseTransform<Real>& mPhases;
    std::vector<int> mDivisors;   // of N
    std::vector<Complex> mRoots;  // [N]: e^{2πi j/N}
};

extern template class LowFrequencyTransform<float>;
extern template class LowFrequencyTransform<double>;
extern template class PhaseTransform<float>;
extern template class PhaseTransform<double>;
extern template class SubsetTransform<float>;
extern template class SubsetTransform<double>;

}  // namespace bandvox
