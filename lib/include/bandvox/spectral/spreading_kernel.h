#pragma once

#include <bandvox/spectral/exponential_filter.h>

#include <array>
#include <vector>

namespace bandvox {

/// The compact kernel ψ that carries weights between arbitrary places and the lattice: the cubic
/// B-spline, or the Kaiser-Bessel window's partner with a closed transform,
///     ψ(x) = I_0(β √(1 - (2x/w)²)) · c  for |x| ≤ w/2, else 0,
///     ψ̂(k) = sinh(√(β² - (πwk)²)) / √(β² - (πwk)²) · β / sinh β,
/// scaled so that ψ̂(0) = 1.
///
/// J. F. Kaiser, R. W. Schafer: "On the use of the I0-sinh window for spectrum analysis" (1980);
/// its use for non-uniform transforms: D. Potts, G. Steidl (2003).
class SpreadingKernel {
  public:
    /// Of all kernels of that kind, the narrowest whose error under `filter` is at most
    /// `tolerance` (see aliasError). Throws Error(ErrorKind::Usage) if none of up to
    /// kMaximumWidth voxels reaches it.
    static SpreadingKernel forFilter(const ExponentialFilter& filter, double tolerance);

    /// `width` in voxels, 2 to kMaximumWidth; `beta` > 0.
    SpreadingKernel(int width, double beta);

    /// The cubic B-spline, whose width is 4.
    static SpreadingKernel cubicSpline() { return SpreadingKernel(); }

    int width() const { return mWidth; }
    double beta() const { return mBeta; }  ///< 0 of the B-spline

    /// ψ(x), x in voxels, by its formula.
    double operator()(double x) const;
    /// ψ'(x), per voxel.
    double derivative(double x) const;
    /// ψ̂(k), k in cycles per voxel.
    double transform(double k) const;
    /// The same for the kernel with a closed transform of this width and β.
    static double transform(int width, double beta, double k);

    /// The weights of the `width()` lattice nodes around a place: weights[j] = ψ(node_j - x),
    /// with node_j = first + j, and zeros from there up to `paddedWidth()` so that rows can be
    /// worked on in whole vectors. Evaluated by polynomials, within a few 1e-7 of ψ(0).
    /// @return the first node.
    int weights(float x, float* weights) const;
    /// The same, and the derivative of each weight with respect to x.
    int weights(float x, float* weights, float* derivatives) const;

    /// The number of weights that `weights` writes: 8 or 16.
    int paddedWidth() const { return mWidth <= 8 ? 8 : kPaddedWidth; }

    static constexpr int kMaximumWidth = 12;
    static constexpr int kPaddedWidth = 16;

    /// The polynomials behind `weights` and of their derivatives with respect to x of this order,
    /// 0 to 2, for loops that evaluate them in place: coefficient p of node j at
    /// [p·kPaddedWidth + j], highest power first, in z = 2 (first - x + w/2) - 1. The degree is
    /// polynomialDegree() - order.
    const std::vector<float>& polynomials(int order = 0) const { return mCoefficients[order]; }
    int polynomialDegree() const { return mDegree; }

  private:
    SpreadingKernel();
    bool isSpline() const { return mBeta == 0; }
    void fitPolynomials();

    int mWidth;
    double mBeta;
    double mScale;                                    // makes ψ̂(0) = 1
    int mDegree = 0;                                  // of the polynomials
    std::array<std::vector<float>, 3> mCoefficients;  // by order: [degree + 1][kPaddedWidth]
};

/// The largest error of the filtered density of a half-space when its boundary reaches the
/// lattice through `kernel`:
///     2 ∫_{1/1024}^{1/2} H(k) Σ_{m≠0} |ψ̂(k + m)| / ψ̂(k) / (2πk) dk.
/// docs/math/exact-route.md derives it, and says why the integral begins where it does.
double aliasError(const ExponentialFilter& filter, const SpreadingKernel& kernel);

}  // namespace bandvox
