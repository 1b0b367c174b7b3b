#include "render/filter_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {

namespace {

constexpr int kSteps = 1024;

// At a distance from the middle, within the radius.
double weightAt(PixelFilter filter, double x) {
    using std::numbers::pi;
    switch (filter) {
        case PixelFilter::Triangle:
            return 1 - std::abs(x);
        case PixelFilter::Gaussian: {
            // Shifted down so that it ends at nothing.
            constexpr double kDeviation = 0.5;
            const auto bell = [](double r) {
                return std::exp(-0.5 * r * r / (kDeviation * kDeviation));
            };
            return bell(x) - bell(filterRadius(filter));
        }
        case PixelFilter::BlackmanHarris: {
            // F. Harris: "On the Use of Windows for Harmonic Analysis" (1978), four terms.
            const double t = pi * (x / filterRadius(filter) + 1);
            return 0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) -
                   0.01168 * std::cos(3 * t);
        }
        case PixelFilter::Box:
            break;
    }
    return 1;
}

}  // namespace

double filterRadius(PixelFilter filter) {
    switch (filter) {
        case PixelFilter::Triangle:
            return 1;
        case PixelFilter::Gaussian:
            return 1.5;
        case PixelFilter::BlackmanHarris:
            return 2;
        case PixelFilter::Box:
            break;
    }
    return 0.5;
}

FilterPlaces::FilterPlaces(PixelFilter filter) : mFilter(filter), mRadius(filterRadius(filter)) {
    if (filter == PixelFilter::Box) return;
    mWeights.push_back(0);
    for (int i = 0; i < kSteps; ++i) {
        const double x = mRadius * ((2 * i + 1.0) / kSteps - 1);
        mWeights.push_back(mWeights.back() + std::max(weightAt(filter, x), 0.0));
    }
    const double total = mWeights.back();
    for (double& weight : mWeights) weight /= total;
}

double FilterPlaces::operator()(double u) const {
    if (mWeights.empty()) return u;
    const auto above = std::upper_bound(mWeights.begin(), mWeights.end(), u);
    const auto step = std::clamp<std::ptrdiff_t>(above - mWeights.begin() - 1, 0, kSteps - 1);
    const double width = mWeights[step + 1] - mWeights[step];
    const double part = width > 0 ? (u - mWeights[step]) / width : 0.5;
    return 0.5 + mRadius * (2 * (static_cast<double>(step) + part) / kSteps - 1);
}

const std::vector<std::string>& pixelFilterNames() {
    static const std::vector<std::string> names{"box", "triangle", "gaussian", "blackman-harris"};
    return names;
}

}  // namespace bandvox
