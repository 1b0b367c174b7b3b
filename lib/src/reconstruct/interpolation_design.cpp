#include "reconstruct/interpolation_design.h"

#include "core/words.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

using std::numbers::pi;

// The prefilter's taps on each side: the halo of a brick is this and half a kernel.
constexpr int kShortestPrefilter = 4;
constexpr int kLongestPrefilter = 32;

// Frequencies at which errors are weighed, midpoints of [0, 1/2].
constexpr int kFrequencies = 256;
constexpr double kFrequencyStep = 0.5 / kFrequencies;
// Images k + m of each frequency, |m| up to this.
constexpr int kImages = 4;
// Waves longer than this many voxels are, within a brick, the constant that is bounded by itself.
constexpr double kLongestWave = 32;

// What a kernel does to the frequencies of the lattice.
struct KernelResponse {
    std::vector<double> pass;           // ψ̂(k)
    std::vector<double> imageValue;     // Σ_{m≠0} |ψ̂(k + m)|
    std::vector<double> imageGradient;  // Σ_{m≠0} |k + m| |ψ̂(k + m)|
    double constantValue = 0;           // Σ_{m≠0} |ψ̂(m)|
    double constantGradient = 0;        // Σ_{m≠0} 2π |m| |ψ̂(m)|
};

double frequency(int i) {
    return (i + 0.5) * kFrequencyStep;
}

// `transform` is ψ̂.
KernelResponse kernelResponse(const std::function<double(double)>& transform) {
    KernelResponse response;
    for (int i = 0; i < kFrequencies; ++i) {
        double value = 0, gradient = 0;
        for (int m = 1; m <= kImages; ++m) {
            for (const double image : {frequency(i) - m, frequency(i) + m}) {
                const double size = std::abs(transform(image));
                value += size;
                gradient += std::abs(image) * size;
            }
        }
        response.pass.push_back(transform(frequency(i)));
        response.imageValue.push_back(value);
        response.imageGradient.push_back(gradient);
    }
    for (int m = 1; m <= kImages; ++m) {
        response.constantValue += 2 * std::abs(transform(m));
        response.constantGradient += 4 * pi * m * std::abs(transform(m));
    }
    return response;
}

// cos 2πkq at frequency i.
double cosine(int i, int q) {
    // Frequencies are odd multiples of a quarter of a turn's 2·kFrequencies-th part.
    constexpr int kPeriod = 4 * kFrequencies;
    static const std::vector<double> table = [] {
        std::vector<double> cosines(kPeriod);
        for (int t = 0; t < kPeriod; ++t) cosines[t] = std::cos(2 * pi * t / kPeriod);
        return cosines;
    }();
    return table[(2 * i + 1) * q % kPeriod];
}

// Solves a symmetric system in place by elimination with row exchanges; `rows` are augmented.
std::vector<double> solve(std::vector<std::vector<double>> rows) {
    const std::size_t n = rows.size();
    for (std::size_t c = 0; c < n; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c + 1; r < n; ++r) {
            if (std::abs(rows[r][c]) > std::abs(rows[pivot][c])) pivot = r;
        }
        std::swap(rows[c], rows[pivot]);
        for (std::size_t r = c + 1; r < n; ++r) {
            const double factor = rows[r][c] / rows[c][c];
            for (std::size_t j = c; j <= n; ++j) rows[r][j] -= factor * rows[c][j];
        }
    }
    std::vector<double> x(n);
    for (std::size_t c = n; c-- > 0;) {
        double sum = rows[c][n];
        for (std::size_t j = c + 1; j < n; ++j) sum -= rows[c][j] * x[j];
        x[c] = sum / rows[c][c];
    }
    return x;
}

// Weighted least squares for a prefilter A(k) = a_0 + 2 Σ a_l cos 2πkl of any reach.
class PrefilterFit {
  public:
    // A(k) ψ̂(k) should be 1 and the images A(k) ψ̂(k + m) should vanish, weighted as they act
    // on the gradient of a half-space, whose spectrum is H(k); `noise` stands for what is on the
    // lattice at all frequencies besides.
    PrefilterFit(const ExponentialFilter& filter, const KernelResponse& response, double noise) {
        for (int i = 0; i < kFrequencies; ++i) {
            const double k = frequency(i);
            const double weight = filter(k) * filter(k) + noise * noise;
            const double pass = response.pass[i];
            const double image = response.imageGradient[i] / k;
            for (int q = 0; q <= 2 * kLongestPrefilter; ++q) {
                mSquares[q] += weight * (pass * pass + image * image) * cosine(i, q);
            }
            for (int l = 0; l <= kLongestPrefilter; ++l) {
                mRight[l] += weight * pass * basis(i, l);
            }
        }
    }

    // The best prefilter of `reach` taps on each side with A(0) = 1, which keeps constants.
    std::vector<double> prefilter(int reach) const {
        const int n = reach + 1;
        std::vector<std::vector<double>> rows(n + 1, std::vector<double>(n + 2, 0.0));
        for (int l = 0; l < n; ++l) {
            // Of two cosines, the product is half the sum of those of the sum and the difference.
            for (int m = 0; m < n; ++m) {
                rows[l][m] = (l == 0 ? 0.5 : 1) * (m == 0 ? 1 : 2) *
                             (mSquares[l + m] + mSquares[std::abs(l - m)]);
            }
            // A trace of the identity keeps the system regular where the noise is nothing.
            rows[l][l] += 1e-15 * mSquares[0];
            rows[l][n] = rows[n][l] = l == 0 ? 1 : 2;
            rows[l][n + 1] = mRight[l];
        }
        rows[n][n + 1] = 1;
        std::vector<double> taps = solve(std::move(rows));
        taps.pop_back();  // the multiplier of the constraint
        return taps;
    }

  private:
    static double basis(int i, int l) { return (l == 0 ? 1 : 2) * cosine(i, l); }

    std::array<double, 2 * kLongestPrefilter + 1> mSquares{};  // Σ weight · cos 2πkq
    std::array<double, kLongestPrefilter + 1> mRight{};
};

struct InterpolationError {
    double value = 0;
    double gradient = 0;  // relative

    double worst() const { return std::max(value, gradient); }
};

// Sums the errors of all frequencies of a half-space as if their phases agreed everywhere.
InterpolationError interpolationError(const ExponentialFilter& filter,
                                      const KernelResponse& response,
                                      const std::vector<double>& prefilter) {
    double value = 0, gradient = 0;
    for (int i = 0; i < kFrequencies; ++i) {
        const double k = frequency(i);
        double a = prefilter[0];
        for (std::size_t l = 1; l < prefilter.size(); ++l) {
            a += 2 * prefilter[l] * cosine(i, static_cast<int>(l));
        }
        const double missed = std::abs(a * response.pass[i] - 1);
        const double weight = 2 * filter(k) * kFrequencyStep;
        gradient += weight * missed;
        value += weight * missed / (2 * pi * k);
        if (k * kLongestWave < 1) continue;
        gradient += weight * std::abs(a) * response.imageGradient[i] / k;
        value += weight * std::abs(a) * response.imageValue[i] / (2 * pi * k);
    }
    // The constant inside the solid has images along each of the three axes.
    return {value + 3 * response.constantValue,
            (gradient + std::numbers::sqrt3 * response.constantGradient) / faceGradient(filter)};
}

// That rounding the sums along three axes to floats costs a small part of a tolerance.
bool roundsLittle(const std::vector<double>& prefilter, double tolerance) {
    constexpr double kPartOfTolerance = 0.2;
    constexpr double kRounding = 0.5 * std::numeric_limits<float>::epsilon();
    double gain = std::abs(prefilter[0]);
    for (std::size_t l = 1; l < prefilter.size(); ++l) gain += 2 * std::abs(prefilter[l]);
    return gain * gain * gain * kRounding <= kPartOfTolerance * tolerance;
}

struct KernelChoice {
    double beta = 0;
    KernelResponse response;
    double error = std::numeric_limits<double>::infinity();
};

// The best kernel of a width, under the longest prefilter. Its β puts the edge of ψ̂'s main lobe
// on the first image of a frequency; which one depends on how much the filter leaves there.
KernelChoice bestKernel(const ExponentialFilter& filter, int width, double noise) {
    KernelChoice best;
    for (double edge = 0.1; edge < 0.47; edge += 0.02) {
        const double beta = 0.985 * pi * width * (1 - edge);
        KernelResponse response =
            kernelResponse([&](double k) { return SpreadingKernel::transform(width, beta, k); });
        const auto prefilter = PrefilterFit(filter, response, noise).prefilter(kLongestPrefilter);
        const double error = interpolationError(filter, response, prefilter).worst();
        if (error < best.error) best = {beta, std::move(response), error};
    }
    return best;
}

}  // namespace

double faceGradient(const ExponentialFilter& filter) {
    double sum = 0;
    for (int i = 0; i < kFrequencies; ++i) sum += filter(frequency(i));
    return 2 * sum * kFrequencyStep;
}

InterpolationDesign designInterpolation(const ExponentialFilter& filter, double tolerance) {
    requireValid(filter);
    const double noise = 0.1 * tolerance;
    double reached = 0;
    for (int width = 4; width <= SpreadingKernel::kMaximumWidth; ++width) {
        const KernelChoice choice = bestKernel(filter, width, noise);
        reached = choice.error;
        if (choice.error > tolerance) continue;

        // Shorten the prefilter as far as the tolerance allows.
        const PrefilterFit fit(filter, choice.response, noise);
        for (int reach = kShortestPrefilter; reach <= kLongestPrefilter; ++reach) {
            std::vector<double> prefilter = fit.prefilter(reach);
            const InterpolationError error = interpolationError(filter, choice.response, prefilter);
            if (error.worst() <= tolerance) {
                const bool single = roundsLittle(prefilter, tolerance);
                return {SpreadingKernel(width, choice.beta), std::move(prefilter), single,
                        error.value, error.gradient};
            }
        }
    }
    throw Error(ErrorKind::Usage, "no interpolation of the lattice reaches an error of " +
                                      inShort(tolerance) + " (best: " + std::to_string(reached) +
                                      "): a filter of order " + inShort(filter.order) +
                                      " and cutoff " + inShort(filter.cutoff) + " leaves " +
                                      inShort(filter.atNyquist()) + " at Nyquist");
}

InterpolationDesign splineInterpolation() {
    // The inverse of the B-spline's values 1/6, 2/3, 1/6 at the nodes: √3 z^|l|.
    constexpr int kReach = 13;  // |z|^13 is 4e-8
    const double z = std::sqrt(3.0) - 2;
    std::vector<double> prefilter;
    for (int l = 0; l <= kReach; ++l) prefilter.push_back(std::sqrt(3.0) * std::pow(z, l));
    return {SpreadingKernel::cubicSpline(), std::move(prefilter)};
}

InterpolationDesign splineAverage() {
    return {SpreadingKernel::cubicSpline(), {1.0}};
}

}  // namespace bandvox
