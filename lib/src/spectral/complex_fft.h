#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace bandvox {

/// The sign in the exponent.
enum class FftDirection { Forward, Backward };

/// How a batch of complex signals of n points lies in memory: point i of signal b is at
/// [i·stride + b·distance], in complex numbers.
struct FftLayout {
    std::ptrdiff_t stride = 1;
    std::ptrdiff_t distance = 0;
};

template <typename Real>
struct FftPlanPair;

/// A batch of complex transforms of n points, single or double precision, without scale.
///
/// Plans are estimated, never measured, so that the result is the same in every run; they are
/// made once per shape of the problem, and used by all threads.
template <typename Real>
class ComplexFft {
  public:
    /// n, batch ≥ 1. Input and output have to be different arrays unless their layouts are the
    /// same.
    static const ComplexFft& get(int n, int batch, FftDirection direction, FftLayout in,
                                 FftLayout out, bool inPlace = false);
    ~ComplexFft();
    ComplexFft(const ComplexFft&) = delete;
    ComplexFft& operator=(const ComplexFft&) = delete;

    void operator()(const std::complex<Real>* in, std::complex<Real>* out) const;

  private:
    ComplexFft(int n, int batch, FftDirection direction, FftLayout in, FftLayout out, bool inPlace);

    std::unique_ptr<FftPlanPair<Real>> mPlans;
};

/// Transforms of half spectra of n points to real signals, without scale; layouts count complex
/// numbers on the input's side and real numbers on the output's. The input is destroyed.
template <typename Real>
class HalfComplexFft {
  public:
    static const HalfComplexFft& get(int n, int batch, FftLayout in, FftLayout out);
    ~HalfComplexFft();
    HalfComplexFft(const HalfComplexFft&) = delete;
    HalfComplexFft& operator=(const HalfComplexFft&) = delete;

    void operator()(std::complex<Real>* in, Real* out) const;

  private:
    HalfComplexFft(int n, int batch, FftLayout in, FftLayout out);

    std::unique_ptr<FftPlanPair<Real>> mPlans;
};

}  // namespace bandvox
