#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace bandvox {

/// Only executing a plan is safe in several threads at once; all planning holds this.
std::mutex& fftPlannerMutex();

struct FftBufferDeleter {
    void operator()(float* data) const;
};

/// Memory aligned for FFTW.
using FftBuffer = std::unique_ptr<float[], FftBufferDeleter>;

/// How the frequencies of n³ real samples, n even, lie in memory.
enum class SpectrumLayout {
    Half,    ///< those with z ≤ n/2, z counted last
    Packed,  ///< the transform of n² n/2 complex samples, of which each is two that follow each
             ///< other along z; PackedFilter multiplies them
};

/// Real transforms of n³ samples in place, with room for a margin behind each axis.
///
/// Sample (x, y, z) lies at (x·yCount + y)·zStride + z, for 0 ≤ x, y < n + margin and 0 ≤ z <
/// n + zMargin. After `forward`, frequency (x, y, z) lies at the complex number
/// (x·yCount + y)·zStride/2 + z. Only the n³ block is transformed. Both directions are without
/// scale: inverse(forward(a)) = n³ a, and half of that if packed.
///
/// Rows of reals are transformed as rows of half as many complex numbers, for which FFTW has far
/// faster code: J. W. Cooley, P. A. W. Lewis, P. D. Welch: "The Fast Fourier Transform Algorithm:
/// Programming Considerations in the Calculation of Sine, Cosine and Laplace Transforms" (1970).
/// Plans are estimated, never measured, so that the result is the same in every run; they are
/// made once per shape of the problem, and used by all threads.
class RealFft3 {
  public:
    /// `inner` is the number of samples per axis that `inverse` has to produce. Throws
    /// Error(ErrorKind::Runtime) if n is odd, or FFTW makes no plan.
    static const RealFft3& get(int n, int margin = 0, int zMargin = 0, int inner = 0,
                               SpectrumLayout layout = SpectrumLayout::Half);
    ~RealFft3();
    RealFft3(const RealFft3&) = delete;
    RealFft3& operator=(const RealFft3&) = delete;

    int size() const { return mSize; }
    int xCount() const { return mXCount; }
    int yCount() const { return mYCount; }
    int zStride() const { return mZStride; }
    SpectrumLayout layout() const { return mLayout; }
    std::size_t bufferSize() const;
    /// A buffer of bufferSize() floats, all zero.
    FftBuffer allocate() const;

    void forward(float* data) const;
    /// Produces only samples with first ≤ x, y < first + inner (and every z).
    void inverse(float* data, int first = 0) const;

  private:
    RealFft3(int n, int margin, int zMargin, int inner, SpectrumLayout layout);

    struct Plans;
    int mSize, mInner, mXCount, mYCount, mZStride;
    SpectrumLayout mLayout;
    std::unique_ptr<Plans> mPlans;
    std::vector<float> mTurns;  // [n/2], complex: -i e^{-2πik/n}
};

}  // namespace bandvox
