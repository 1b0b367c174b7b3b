#include "spectral/sight_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bandvox {

namespace {
constexpr int kPadding = 4;
constexpr double kRefinement = 1e-5;  // of a step
constexpr int kMostRefinements = 60;

template <typename Real>
constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();

}  // namespace

template <typename Real>
SightLines<Real>::SightLines(const PhaseTransform<Real>& phases)
    : mPhases(phases),
      mFrequencies(phases.frequencies()),
      mMagnification(phases.magnification()),
      mHalf(mFrequencies / 2),
      mRowStride((mHalf + 1 + kPadding - 1) / kPadding * kPadding),
      mTransform(&HalfComplexFft<Real>::get(mFrequencies, mMagnification, {1, mRowStride},
                                            {1, mFrequencies})) {}

template <typename Real>
typename SightLines<Real>::Work SightLines<Real>::makeWork() const {
    Work work;
    work.turned.resize(static_cast<std::size_t>(mMagnification) * mRowStride);
    work.values.resize(static_cast<std::size_t>(mMagnification) * mFrequencies);
    return work;
}

template <typename Real>
Real SightLines<Real>::bound(const Complex* spectrum) const {
    const auto magnitude = [&](int n) {
        const Real re = spectrum[n].real();
        const Real im = spectrum[n].imag();
        return std::sqrt(re * re + im * im);
    };
    Real sum = 0;
    for (int n = 1; n < mHalf; ++n) sum += magnitude(n);
    // More than what rounding takes off.
    const Real slack = 1 + 8 * static_cast<Real>(mFrequencies) * kEpsilon<Real>;
    return slack * (magnitude(0) + 2 * sum) / static_cast<Real>(mFrequencies);
}

template <typename Real>
std::optional<double> SightLines<Real>::crossing(const Complex* spectrum, double iso, bool refine,
                                                 Work& work, OperationCount& count) const {
    // Interpolate the whole line, phase by phase.
    const int n = mFrequencies;
    const Real scale = Real(1) / static_cast<Real>(n);
    for (int s = 0; s < mMagnification; ++s) {
        const Complex* turn = mPhases.twiddles(s).data();
        Complex* turned = work.turned.data() + static_cast<std::size_t>(s) * mRowStride;
        for (int k = 0; k < mHalf; ++k) {
            const Complex a = spectrum[k] * scale;
            turned[k] = Complex(a.real() * turn[k].real() - a.imag() * turn[k].imag(),
                                a.real() * turn[k].imag() + a.imag() * turn[k].real());
        }
        turned[mHalf] = 0;
    }
    (*mTransform)(work.turned.data(), work.values.data());
    count.multiplications += mMagnification * (mHalf + 0.5 * n * std::log2(n));

    // Find the first density above the iso-value.
    const auto level = static_cast<Real>(iso);
    const std::vector<Real>& values = work.values;
    if (*std::max_element(values.begin(), values.end()) <= level) return std::nullopt;
    const auto at = [&](int z) {
        return values[static_cast<std::size_t>(z % mMagnification) * n + z / mMagnification];
    };
    int z = 0;
    while (at(z) <= level) ++z;
    if (z == 0) return 0;
    if (refine) return refined(spectrum, iso, z - 1, z, count);
    return level - at(z - 1) < at(z) - level ? z - 1 : z;
}

// Regula falsi, in Illinois' variant, between a step that is outside and one that is inside.
template <typename Real>
double SightLines<Real>::refined(const Complex* spectrum, double iso, double outside, double inside,
                                 OperationCount& count) const {
    double below = valueAt(spectrum, outside, count) - iso;
    double above = valueAt(spectrum, inside, count) - iso;
    double z = inside;
    int lastMoved = 0;  // -1: outside, 1: inside
    for (int i = 0; i < kMostRefinements && inside - outside > kRefinement; ++i) {
        // Rounding can bring both ends to one side.
        if (!(below <= 0 && above > 0)) break;
        const double last = z;
        z = outside + (inside - outside) * below / (below - above);
        const double value = valueAt(spectrum, z, count) - iso;
        const int moved = value <= 0 ? -1 : 1;
        (moved < 0 ? outside : inside) = z;
        (moved < 0 ? below : above) = value;
        if (moved == lastMoved) (moved < 0 ? above : below) *= 0.5;
        lastMoved = moved;
        if (std::abs(z - last) < 0.5 * kRefinement || value == 0) break;
    }
    return z;
}

// Calls visit(n, e^{2πi nz/M}) for 0 < n < N/2.
template <typename Real>
template <typename Visitor>
void SightLines<Real>::forEachWave(double z, const Visitor& visit) const {
    const double places = static_cast<double>(mFrequencies) * mMagnification;
    const double angle = 2 * std::numbers::pi * z / places;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    double re = c;
    double im = s;
    for (int n = 1; n < mHalf; ++n) {
        visit(n, re, im);
        const double next = re * c - im * s;
        im = re * s + im * c;
        re = next;
    }
}

template <typename Real>
double SightLines<Real>::valueAt(const Complex* spectrum, double z, OperationCount& count) const {
    double sum = 0.5 * spectrum[0].real();
    forEachWave(z, [&](int n, double re, double im) {
        sum += spectrum[n].real() * re - spectrum[n].imag() * im;
    });
    count.multiplications += mHalf;
    return 2 * sum / mFrequencies;
}

template <typename Real>
double SightLines<Real>::slopeAt(const Complex* spectrum, double z, OperationCount& count) const {
    double sum = 0;
    forEachWave(z, [&](int n, double re, double im) {
        sum -= n * (spectrum[n].real() * im + spectrum[n].imag() * re);
    });
    count.multiplications += 2.0 * mHalf;
    return 4 * std::numbers::pi * sum / (static_cast<double>(mFrequencies) * mFrequencies);
}

template class SightLines<float>;
template class SightLines<double>;

}  // namespace bandvox
