#pragma once

#include <bandvox/source/field_source.h>
#include <bandvox/spectral/spectral_volume.h>

#include <fftw3.h>

#include <cstddef>
#include <vector>

namespace bandvox::benchmarks {

/// What one does without pruning: a real array of n³ and FFTW's three-dimensional transform of
/// it, in place and with threads.
class DenseTransform {
  public:
    /// Plans with FFTW's estimate, as the library does.
    DenseTransform(int n, int threads, bool inverse);
    ~DenseTransform();
    DenseTransform(const DenseTransform&) = delete;
    DenseTransform& operator=(const DenseTransform&) = delete;

    /// Samples the field at the n³ places, transforms, keeps N³ of its frequencies and filters
    /// them.
    SpectralVolume lowPass(const FieldSource& source, int resolution,
                           const ExponentialFilter& filter, const SpectralDomain& domain);

    /// The densities at n³ places of a volume, and where each line along z first exceeds `iso`,
    /// [x][y], in steps; -1 where none.
    std::vector<int> crossings(const SpectralVolume& volume, float iso);

  private:
    float* row(int x, int y) {
        return mData + (static_cast<std::size_t>(x) * mSize + y) * 2 * mHalf;
    }
    fftwf_complex* frequencies(int x, int y) { return reinterpret_cast<fftwf_complex*>(row(x, y)); }

    int mSize, mHalf;  // n, n/2 + 1
    float* mData;      // [n][n][2·mHalf]
    fftwf_plan mPlan;
};

}  // namespace bandvox::benchmarks
