#include <bandvox/core/error.h>
#include <bandvox/spectral/exponential_filter.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

constexpr double kPi = std::numbers::pi;

// The integral over k is a midpoint sum in steps of kFrequencyStep; a step of 1/P repeats the
// half-space every P voxels, so P only has to be far beyond the longest reach.
constexpr double kFrequencyStep = 1.0 / 2048;
constexpr double kLongestReach = 256;
constexpr double kReachStep = 0.125;

// Where H has fallen below 1e-17.
double highestFrequency(const ExponentialFilter& filter) {
    return filter.cutoff * std::pow(39.1, 1 / filter.order);
}

}  // namespace

double ExponentialFilter::operator()(double k) const {
    return std::exp(-std::pow(std::abs(k) / cutoff, order));
}

void requireValid(const ExponentialFilter& filter) {
    if (!(filter.order >= 0.5 && filter.order <= 64)) {
        throw Error(ErrorKind::Usage, "the filter's order is " + std::to_string(filter.order) +
                                          "; it must be between 0.5 and 64");
    }
    if (!(filter.cutoff >= 0.01 && filter.cutoff <= 0.5)) {
        throw Error(ErrorKind::Usage, "the filter's cutoff is " + std::to_string(filter.cutoff) +
                                          "; it must be between 0.01 and 0.5 cycles per voxel");
    }
}

double halfSpaceDensity(const ExponentialFilter& filter, double distance) {
    const double highest = highestFrequency(filter);
    double sum = 0;
    for (double k = kFrequencyStep / 2; k < highest; k += kFrequencyStep) {
        sum += filter(k) * std::sin(2 * kPi * k * distance) / (kPi * k);
    }
    return 0.5 - sum * kFrequencyStep;
}

double filterReach(const ExponentialFilter& filter, double tolerance) {
    double reach = 0;
    double searched = 32;
    // Look twice as far until the last quarter of what was searched is quiet.
    for (double r = kReachStep; r <= searched; r += kReachStep) {
        if (std::abs(halfSpaceDensity(filter, r)) > tolerance) reach = r;
        if (r + kReachStep > searched && reach > 0.75 * searched) {
            searched *= 2;
            if (searched > kLongestReach) {
                throw Error(ErrorKind::Usage,
                            "a filter of order " + std::to_string(filter.order) + " and cutoff " +
                                std::to_string(filter.cutoff) + " reaches farther than " +
                                std::to_string(static_cast<int>(kLongestReach)) +
                                " voxels at a tolerance of " + std::to_string(tolerance) +
                                "; raise the order, the cutoff or the tolerance");
            }
        }
    }
    return reach + kReachStep;
}

double filterOvershoot(const ExponentialFilter& filter) {
    double overshoot = 0;
    for (double r = 0; r <= 32; r += kReachStep) {
        overshoot = std::max(overshoot, -halfSpaceDensity(filter, r));
    }
    return overshoot;
}

}  // namespace bandvox
