#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/spectral/exponential_filter.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox {

namespace {

using std::numbers::pi;

// The integral over k is a midpoint sum in steps of kFrequencyStep; a step of 1/P repeats the
// half-space every P voxels, so P only has to be far beyond the longest reach.
constexpr double kFrequencyStep = 1.0 / 2048;
constexpr double kLongestReach = 256;
constexpr double kReachStep = 0.125;

// Where H has fallen below 1e-17.
double highestFrequency(const ExponentialFilter& filter) {
    return filter.cutoff * std::pow(39.1, 1 / filter.order);
}

// The filtered half-space, for many distances: the filter is tabulated once.
class HalfSpace {
  public:
    explicit HalfSpace(const ExponentialFilter& filter) {
        const double highest = highestFrequency(filter);
        for (double k = kFrequencyStep / 2; k < highest; k += kFrequencyStep) {
            mWeights.push_back(filter(k) / (pi * k) * kFrequencyStep);
        }
    }

    double density(double distance) const {
        // sin(2πkr) for k in equal steps, by turning a number of length 1.
        const double angle = 2 * pi * kFrequencyStep * distance;
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        double re = std::cos(angle / 2);
        double im = std::sin(angle / 2);
        double sum = 0;
        for (const double weight : mWeights) {
            sum += weight * im;
            const double next = re * c - im * s;
            im = re * s + im * c;
            re = next;
        }
        return 0.5 - sum;
    }

  private:
    std::vector<double> mWeights;  // H(k) dk / (πk)
};

}  // namespace

double ExponentialFilter::operator()(double k) const {
    return std::exp(-std::pow(std::abs(k) / cutoff, order));
}

void requireValid(const ExponentialFilter& filter) {
    if (!(filter.order >= 1 && filter.order <= 64)) {
        throw Error(ErrorKind::Usage, "the filter's order is " + inShort(filter.order) +
                                          "; it must be between 1 and 64");
    }
    if (!(filter.cutoff >= 0.01 && filter.cutoff <= 0.5)) {
        throw Error(ErrorKind::Usage, "the filter's cutoff is " + inShort(filter.cutoff) +
                                          "; it must be between 0.01 and 0.5 cycles per voxel");
    }
}

double halfSpaceDensity(const ExponentialFilter& filter, double distance) {
    return HalfSpace(filter).density(distance);
}

double filterReach(const ExponentialFilter& filter, double tolerance) {
    const HalfSpace halfSpace(filter);
    double reach = 0;
    double searched = 32;
    // Look twice as far until the last quarter of what was searched is quiet.
    for (double r = kReachStep; r <= searched; r += kReachStep) {
        if (std::abs(halfSpace.density(r)) > tolerance) reach = r;
        if (r + kReachStep > searched && reach > 0.75 * searched) {
            searched *= 2;
            if (searched > kLongestReach) {
                throw Error(
                    ErrorKind::Usage,
                    "a filter of order " + inShort(filter.order) + " and cutoff " +
                        inShort(filter.cutoff) + " reaches farther than " + inShort(kLongestReach) +
                        " voxels at a tolerance of " + inShort(tolerance) + "; " +
                        (filter.order < 2 ? "raise the order, " : "lower the order, or raise ") +
                        "the cutoff or the tolerance");
            }
        }
    }
    return reach + kReachStep;
}

double filterOvershoot(const ExponentialFilter& filter) {
    const HalfSpace halfSpace(filter);
    double overshoot = 0;
    for (double r = 0; r <= 32; r += kReachStep) {
        overshoot = std::max(overshoot, -halfSpace.density(r));
    }
    return overshoot;
}

}  // namespace bandvox
