#pragma once

#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/Types.h>

#include <complex>
#include <cstddef>
#include <vector>

namespace bandvox {

/// The cube of space that a SpectralVolume describes, and beyond which it repeats. Voxel
/// (x, y, z) of N³ is at origin + (x, y, z)·side/N.
struct SpectralDomain {
    openvdb::Vec3d origin{-1, -1, -1};  ///< world units
    double side = 2;                    ///< world units; > 0
};

/// A periodic band-limited density by its low frequencies: the paper's voxel representation
/// F~_N^R, dense and whole. It is small, exact, and the oracle for everything that is neither.
///
///     f~(x, y, z) = 1/N³ Σ F(l, m, n) e^{2πi (lx + my + nz)/N},  l, m, n signed, x, y, z voxels.
///
/// Frequencies at Nyquist are 0, because they have no sign; so N has to be even. Made for
/// `float` (SpectralVolume) and `double` (PreciseSpectralVolume).
///
/// N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), sections 3.1 and 3.2.
template <typename Real>
class BasicSpectralVolume {
  public:
    using Complex = std::complex<Real>;

    /// All frequencies 0. `resolution`: N, even, 2 to 4096. `samples`: R, along each side, of
    /// which the frequencies were taken; a multiple of N. `filter`: what they were multiplied
    /// with, cycles per voxel (of N). Throws Error(ErrorKind::Usage) otherwise and
    /// Error(ErrorKind::Memory) if it would not fit.
    BasicSpectralVolume(int resolution, int samples, const ExponentialFilter& filter,
                        const SpectralDomain& domain);

    int resolution() const { return mResolution; }
    int samples() const { return mSamples; }
    const ExponentialFilter& filter() const { return mFilter; }
    const SpectralDomain& domain() const { return mDomain; }
    double voxelSize() const { return mDomain.side / mResolution; }

    /// The density is real, so F(-l, -m, -n) is the conjugate of F(l, m, n), and only n ≥ 0 is
    /// stored: index (l, m, n) at [(l·N + m)·rowStride() + n], 0 ≤ n ≤ N/2, with l and m in the
    /// order of a transform (signedFrequency). The rest of a row is 0.
    int rowStride() const { return mRowStride; }
    Complex* row(int l, int m) { return mData.data() + rowAt(l, m); }
    const Complex* row(int l, int m) const { return mData.data() + rowAt(l, m); }
    std::size_t size() const { return mData.size(); }

    /// F at signed frequencies, -N/2 ≤ l, m, n < N/2.
    Complex coefficient(int l, int m, int n) const;

    /// The density at a place in voxels, by the sum above: N³ terms, slow, for tests.
    double directValue(const openvdb::Vec3d& voxel) const;
    /// Its gradient, per voxel, by the sum of 2πi (l, m, n)/N times the same terms.
    openvdb::Vec3d directGradient(const openvdb::Vec3d& voxel) const;

    /// The density at the N³ voxels, [x][y][z].
    std::vector<Real> lattice() const;

  private:
    std::size_t rowAt(int l, int m) const {
        return (static_cast<std::size_t>(l) * mResolution + m) * mRowStride;
    }

    int mResolution, mSamples;
    ExponentialFilter mFilter;
    SpectralDomain mDomain;
    int mRowStride;
    std::vector<Complex> mData;
};

using SpectralVolume = BasicSpectralVolume<float>;
using PreciseSpectralVolume = BasicSpectralVolume<double>;

extern template class BasicSpectralVolume<float>;
extern template class BasicSpectralVolume<double>;

}  // namespace bandvox
