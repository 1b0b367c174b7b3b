#pragma once

#include "bandlimit/tile_plan.h"
#include "spectral/fft.h"
#include "spectral/row_transform.h"

#include <bandvox/spectral/pruned_transform.h>

#include <complex>
#include <optional>
#include <vector>

namespace bandvox {

/// The tables of Algorithm I for tiles of T voxels that are sampled R = P·T times along each axis:
/// the samples' T low frequencies, filtered, become the density.
///
/// Immutable once built, and shared by all threads; each has a TileSamples of its own.
class TileReduction {
  public:
    TileReduction(const TileGeometry& geometry, int oversample);

    int samples() const { return mReduce.samples(); }
    const TileGeometry& geometry() const { return mGeometry; }

    /// A buffer for one thread's filtering.
    FftBuffer allocate() const { return mFft.allocate(); }

    /// Bytes that each thread needs.
    double memory() const;

    /// The density along z at (x, y, 0) of the interior, after TileSamples::filter.
    const float* row(const float* buffer, int x, int y) const {
        return buffer +
               (static_cast<std::size_t>(x + mGeometry.halo) * mFft.yCount() + y + mGeometry.halo) *
                   mFft.zStride() +
               mGeometry.halo;
    }

  private:
    friend class TileSamples;

    TileGeometry mGeometry;
    int mRowStride;  // complex numbers from row to row
    RowTransform mRows;
    LowFrequencyTransform<float> mReduce;
    const RealFft3& mFft;
    std::vector<float> mTransfer;  // [T/2]³: H(|k|) / R³
};

/// The low frequencies of one tile while its samples come in, plane by plane of x and, in a plane,
/// row by row.
class TileSamples {
  public:
    explicit TileSamples(const TileReduction& reduction);

    /// A new tile begins.
    void begin();

    /// Rows y and y + 1 of the plane, along z; y is even. Of each plane all rows have to come.
    void addRows(int y, const float* first, const float* second);
    /// Row y of the plane has one value.
    void addConstantRow(int y, float value);
    /// The plane of the rows that came since the last one was the one at x.
    void finishPlane(int x);
    /// All of the plane at x is one value.
    void addConstantPlane(int x, float value);

    /// The value that all samples of the tile have, if it is one.
    std::optional<float> constant() const;

    /// Filters the tile: the density comes to lie in the buffer, where TileReduction::row finds it.
    void filter(float* buffer);

  private:
    using Complex = std::complex<float>;

    /// Whether all values seen are one, and which.
    struct OneValue {
        void see(float value) {
            isOne = isOne && (!isAny || value == first);
            first = value;
            isAny = true;
        }
        float first = 0;
        bool isAny = false, isOne = true;
    };

    Complex* plane(int x) { return mPlanes.data() + static_cast<std::size_t>(x) * mPlaneSize; }
    void multiplyRow(int y, Complex* row, std::size_t planeStride) const;

    const TileReduction& mReduction;
    std::size_t mPlaneSize;
    std::vector<Complex> mRows;    // [R][rowStride]: W2 of the paper's figure 12
    std::vector<Complex> mPlanes;  // [R][T][rowStride]: W3
    std::vector<Complex> mScratch;
    OneValue mPlaneValue, mTileValue;
};

}  // namespace bandvox
