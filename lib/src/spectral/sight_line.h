#pragma once

#include "spectral/complex_fft.h"

#include <bandvox/spectral/pruned_transform.h>

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace bandvox {

/// Lines of sight along z, each given by its N/2 + 1 frequencies; Nyquist is 0. One object serves
/// all threads; the arrays that a thread needs are in a SightLines::Work.
template <typename Real>
class SightLines {
  public:
    using Complex = std::complex<Real>;

    /// `phases` gives N and L, and has to outlive this object.
    explicit SightLines(const PhaseTransform<Real>& phases);

    /// The work arrays of one thread: LN numbers of each kind.
    struct Work {
        std::vector<Complex> turned;  // [L][N/2 + 1, padded]
        std::vector<Real> values;     // [L][N]: f(s + rL) at [s][r]
    };
    Work makeWork() const;

    /// The largest magnitude that the sum of the line's waves, n < 0 included, can have anywhere:
    /// the highest density of a line of sight, and the most that one of the frequencies along x or
    /// y, whose term n = 0 is complex, can add to one.
    Real bound(const Complex* spectrum) const;

    /// The first place z, in steps of 1/L voxel, where the line's density is above `iso`; the
    /// step before it, if that is nearer in density (figure 7), or in between where it is equal to
    /// `iso`, to 1e-5 of a step, if `refine`.
    std::optional<double> crossing(const Complex* spectrum, double iso, bool refine, Work& work,
                                   OperationCount& count) const;

    /// IDFT_N of figure 14: the density at z, in steps of 1/L voxel, by a sum of N terms.
    double valueAt(const Complex* spectrum, double z, OperationCount& count) const;
    /// The same of the spectrum multiplied by 2πi n/N: the derivative along z, per voxel.
    double slopeAt(const Complex* spectrum, double z, OperationCount& count) const;

  private:
    template <typename Visitor>
    void forEachWave(double z, const Visitor& visit) const;
    double refined(const Complex* spectrum, double iso, double outside, double inside,
                   OperationCount& count) const;

    const PhaseTransform<Real>& mPhases;
    int mFrequencies, mMagnification;
    int mHalf;  // frequencies 0 ≤ n < N/2
    int mRowStride;
    const HalfComplexFft<Real>* mTransform;
};

}  // namespace bandvox
