#pragma once

#include <bandvox/spectral/exponential_filter.h>
#include <bandvox/spectral/spreading_kernel.h>

#include <vector>

namespace bandvox {

/// A way to read a lattice between its nodes: f~(x) = Σ_l c_l ψ(l - x) with c = a * f, along each
/// axis. docs/math/reconstruction.md derives it.
struct InterpolationDesign {
    SpreadingKernel kernel;         ///< ψ
    std::vector<double> prefilter;  ///< a_0 ... a_L; a_{-l} = a_l
    /// That the prefilter's sums may be rounded to floats. One that goes far towards Nyquist has
    /// terms a thousand times its sum, whose rounding would be seen.
    bool singlePrecision = false;
    double valueError = 0;     ///< bound for a filtered half-space, density
    double gradientError = 0;  ///< bound, relative to the gradient on its face

    int reach() const { return static_cast<int>(prefilter.size()) - 1; }
};

/// The gradient of the filtered density of a half-space on its face, per voxel: 2 ∫_0^½ H dk.
double faceGradient(const ExponentialFilter& filter);

/// The cheapest design whose errors are at most `tolerance`, value in density and gradient
/// relative to a flat face's. Throws Error(ErrorKind::Usage) if there is none.
InterpolationDesign designInterpolation(const ExponentialFilter& filter, double tolerance);

/// The cubic B-spline through the lattice's values, to a float's precision.
InterpolationDesign splineInterpolation();

/// The cubic B-spline whose coefficients are the lattice's values.
InterpolationDesign splineAverage();

}  // namespace bandvox
