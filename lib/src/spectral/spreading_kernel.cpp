#include "core/words.h"
#include "spectral/kernel_polynomials.h"

#include <bandvox/core/error.h>
#include <bandvox/spectral/spreading_kernel.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

using std::numbers::pi;

// Accuracy of the polynomials relative to ψ(0), a little above a float's.
constexpr double kPolynomialError = 1e-7;
constexpr int kHighestDegree = 16;

// sinh(√z)/√z, which is an entire function of z.
double sinhRatio(double z) {
    if (std::abs(z) < 1e-8) return 1 + z / 6;
    const double root = std::sqrt(std::abs(z));
    return z > 0 ? std::sinh(root) / root : std::sin(root) / root;
}

// ψ̂(k) times sinh β / β.
double kernelTransform(int width, double beta, double k) {
    const double a = pi * width * k;
    return sinhRatio(beta * beta - a * a);
}

// The polynomial of degree `degree` through the Chebyshev nodes of [-1, 1], as coefficients of
// rising powers.
template <typename Function>
std::vector<double> interpolate(int degree, const Function& f) {
    // Expand in Chebyshev polynomials by the discrete cosine sum.
    const int n = degree + 1;
    std::vector<double> chebyshev(n, 0.0);
    for (int i = 0; i < n; ++i) {
        const double angle = pi * (i + 0.5) / n;
        const double value = f(std::cos(angle));
        for (int m = 0; m < n; ++m) {
            chebyshev[m] += (m == 0 ? 1.0 : 2.0) / n * value * std::cos(m * angle);
        }
    }
    // Change to powers with T_{m+1} = 2 z T_m - T_{m-1}.
    std::vector<double> powers(n, 0.0), previous(n, 0.0), current(n, 0.0);
    current[0] = 1;
    for (int m = 0; m < n; ++m) {
        for (int p = 0; p < n; ++p) powers[p] += chebyshev[m] * current[p];
        std::vector<double> next(n, 0.0);
        for (int p = 0; p + 1 < n; ++p) next[p + 1] = (m == 0 ? 1.0 : 2.0) * current[p];
        for (int p = 0; p < n; ++p) next[p] -= m == 0 ? 0.0 : previous[p];
        previous = current;
        current = next;
    }
    return powers;
}

double evaluatePowers(const std::vector<double>& powers, double z) {
    double value = 0;
    for (std::size_t p = powers.size(); p-- > 0;) value = value * z + powers[p];
    return value;
}

}  // namespace

SpreadingKernel::SpreadingKernel(int width, double beta)
    : mWidth(width), mBeta(beta), mScale(1 / (width * sinhRatio(beta * beta))) {
    if (width < 2 || width > kMaximumWidth || !(beta > 0)) {
        throw Error(ErrorKind::Usage, "a spreading kernel of width " + std::to_string(width) +
                                          " and beta " + std::to_string(beta) +
                                          "; the width must be 2 to " +
                                          std::to_string(kMaximumWidth) + ", beta positive");
    }
    fitPolynomials();
}

SpreadingKernel::SpreadingKernel() : mWidth(4), mBeta(0), mScale(1) {
    fitPolynomials();
}

double SpreadingKernel::operator()(double x) const {
    if (isSpline()) {
        const double r = std::abs(x);
        if (r >= 2) return 0;
        return r >= 1 ? std::pow(2 - r, 3) / 6 : 2.0 / 3 - r * r + 0.5 * r * r * r;
    }
    const double u = 2 * x / mWidth;
    if (std::abs(u) > 1) return 0;
    return mScale * std::cyl_bessel_i(0.0, mBeta * std::sqrt(1 - u * u));
}

double SpreadingKernel::derivative(double x) const {
    if (isSpline()) {
        const double r = std::abs(x);
        if (r >= 2) return 0;
        const double slope = r >= 1 ? -0.5 * (2 - r) * (2 - r) : -2 * r + 1.5 * r * r;
        return x < 0 ? -slope : slope;
    }
    const double u = 2 * x / mWidth;
    if (std::abs(u) > 1) return 0;
    // I_1(z) / z, which is 1/2 at the kernel's end.
    const double z = mBeta * std::sqrt(1 - u * u);
    const double ratio = z < 1e-6 ? 0.5 : std::cyl_bessel_i(1.0, z) / z;
    return -mScale * mBeta * mBeta * ratio * u * 2 / mWidth;
}

double SpreadingKernel::transform(double k) const {
    if (isSpline()) {
        const double angle = pi * k;
        return std::abs(angle) < 1e-9 ? 1 : std::pow(std::sin(angle) / angle, 4);
    }
    return transform(mWidth, mBeta, k);
}

double SpreadingKernel::transform(int width, double beta, double k) {
    return kernelTransform(width, beta, k) / sinhRatio(beta * beta);
}

void SpreadingKernel::fitPolynomials() {
    // Node j lies z = 2 d - 1 in its own unit interval, with d in [0, 1) the same for all nodes.
    const auto weightOfNode = [this](int j, double z) {
        return (*this)((z + 1) / 2 - 0.5 * mWidth + j);
    };
    std::vector<std::vector<double>> powers(mWidth);
    const double accepted = kPolynomialError * (*this)(0);
    for (mDegree = mWidth; mDegree <= kHighestDegree; ++mDegree) {
        double error = 0;
        for (int j = 0; j < mWidth; ++j) {
            powers[j] = interpolate(mDegree, [&](double z) { return weightOfNode(j, z); });
            for (double z = -0.999; z < 1; z += 0.027) {
                error =
                    std::max(error, std::abs(evaluatePowers(powers[j], z) - weightOfNode(j, z)));
            }
        }
        if (error <= accepted || mDegree == kHighestDegree) break;
    }
    for (int order = 0; order < static_cast<int>(mCoefficients.size()); ++order) {
        const int degree = mDegree - order;
        std::vector<float>& coefficients = mCoefficients[order];
        coefficients.assign((degree + 1) * kPaddedWidth, 0.0F);
        for (int j = 0; j < mWidth; ++j) {
            for (int p = 0; p <= degree; ++p) {
                coefficients[(degree - p) * kPaddedWidth + j] = static_cast<float>(powers[j][p]);
            }
            // Differentiate; d falls as x rises: dz/dx = -2.
            for (int p = 0; p < degree; ++p) powers[j][p] = -2 * (p + 1) * powers[j][p + 1];
        }
    }
}

int SpreadingKernel::weights(float x, float* weights) const {
    const NodePlace place = placeOfNodes(mWidth, x);
    if (paddedWidth() == 8) {
        evaluateNodes<8>(mCoefficients[0].data(), mDegree, place.z, weights);
    } else {
        evaluateNodes<16>(mCoefficients[0].data(), mDegree, place.z, weights);
    }
    return place.first;
}

int SpreadingKernel::weights(float x, float* weights, float* derivatives) const {
    const NodePlace place = placeOfNodes(mWidth, x);
    if (paddedWidth() == 8) {
        evaluateNodes<8>(mCoefficients[1].data(), mDegree - 1, place.z, derivatives);
    } else {
        evaluateNodes<16>(mCoefficients[1].data(), mDegree - 1, place.z, derivatives);
    }
    return this->weights(x, weights);
}

namespace {

// The error of aliasError, before a kernel with its polynomials is made.
double aliasErrorOf(const ExponentialFilter& filter, int width, double beta) {
    // The sum along x is snapped to whole numbers away from the surface, so wavelengths beyond a
    // thousand voxels never add up; the midpoint rule starts there.
    constexpr int kSteps = 256;
    constexpr double kStep = 0.5 / kSteps;
    double error = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double k = (i + 0.5) * kStep;
        double aliases = 0;
        for (int m = 1; m <= 3; ++m) {
            aliases += std::abs(kernelTransform(width, beta, m - k)) +
                       std::abs(kernelTransform(width, beta, m + k));
        }
        error += filter(k) * aliases / std::abs(kernelTransform(width, beta, k)) / (2 * pi * k);
    }
    return 2 * error * kStep;
}

}  // namespace

double aliasError(const ExponentialFilter& filter, const SpreadingKernel& kernel) {
    return aliasErrorOf(filter, kernel.width(), kernel.beta());
}

SpreadingKernel SpreadingKernel::forFilter(const ExponentialFilter& filter, double tolerance) {
    double best = 0;
    for (int width = 3; width <= kMaximumWidth; ++width) {
        // The error as a function of β has one broad minimum with narrow dips where ψ̂ has a zero
        // at a whole frequency: walk over it in fine steps.
        double bestBeta = 0;
        best = 0;
        for (double beta = 1.4 * width; beta <= 2.3 * width; beta += 0.125) {
            const double error = aliasErrorOf(filter, width, beta);
            if (bestBeta == 0 || error < best) {
                best = error;
                bestBeta = beta;
            }
        }
        if (best <= tolerance) return SpreadingKernel(width, bestBeta);
    }
    throw Error(ErrorKind::Usage,
                "no spreading kernel of up to " + std::to_string(kMaximumWidth) +
                    " voxels reaches an error of " + inShort(tolerance) +
                    " with a filter of order " + inShort(filter.order) + " and cutoff " +
                    inShort(filter.cutoff) + " (best: " + inShort(best) +
                    "); lower the cutoff, raise the order or raise the tolerance");
}

}  // namespace bandvox
