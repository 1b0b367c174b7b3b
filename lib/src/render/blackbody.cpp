#include "render/blackbody.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox {

using openvdb::Vec3d;

namespace {

constexpr double kLowest = 500, kHighest = 40000, kReference = 2000;  // kelvin
constexpr int kSteps = 512;

// A bell of another width on either side.
double bell(double x, double middle, double left, double right) {
    const double t = (x - middle) * (x < middle ? left : right);
    return std::exp(-0.5 * t * t);
}

// The eye's response at a wavelength in nanometres: X, Y, Z.
Vec3d eyeResponse(double nm) {
    return {1.056 * bell(nm, 599.8, 0.0264, 0.0323) + 0.362 * bell(nm, 442.0, 0.0624, 0.0374) -
                0.065 * bell(nm, 501.1, 0.0490, 0.0382),
            0.821 * bell(nm, 568.8, 0.0213, 0.0247) + 0.286 * bell(nm, 530.9, 0.0613, 0.0322),
            1.217 * bell(nm, 437.0, 0.0845, 0.0278) + 0.681 * bell(nm, 459.0, 0.0385, 0.0725)};
}

// X, Y, Z of a body of this temperature, but for a factor.
Vec3d tristimulus(double kelvin) {
    constexpr double kSecondConstant = 1.438777e7;  // hc/k, nanometres kelvin
    Vec3d sum(0.0);
    for (double nm = 380; nm <= 780; nm += 2) {
        const double scaled = nm / 560;
        sum +=
            eyeResponse(nm) / (std::pow(scaled, 5) * std::expm1(kSecondConstant / (nm * kelvin)));
    }
    return sum;
}

Vec3d toLinearSrgb(const Vec3d& xyz) {
    const Vec3d rgb(3.2406 * xyz[0] - 1.5372 * xyz[1] - 0.4986 * xyz[2],
                    -0.9689 * xyz[0] + 1.8758 * xyz[1] + 0.0415 * xyz[2],
                    0.0557 * xyz[0] - 0.2040 * xyz[1] + 1.0570 * xyz[2]);
    return {std::max(rgb[0], 0.0), std::max(rgb[1], 0.0), std::max(rgb[2], 0.0)};
}

double temperatureOf(double step) {
    return kLowest * std::pow(kHighest / kLowest, step / kSteps);
}

}  // namespace

Vec3d blackbodyColor(double kelvin) {
    if (!(kelvin >= kLowest)) return Vec3d(0.0);
    // Logarithms, since from step to step the light changes by factors.
    static const std::array<Vec3d, kSteps + 1> table = [] {
        const double reference = tristimulus(kReference)[1];
        std::array<Vec3d, kSteps + 1> colors;
        for (int i = 0; i <= kSteps; ++i) {
            const Vec3d color = toLinearSrgb(tristimulus(temperatureOf(i)) / reference);
            for (int c = 0; c < 3; ++c) colors[i][c] = std::log(std::max(color[c], 1e-30));
        }
        return colors;
    }();
    const double place =
        std::min(kSteps * std::log(kelvin / kLowest) / std::log(kHighest / kLowest), 1.0 * kSteps);
    const int step = std::min(static_cast<int>(place), kSteps - 1);
    const Vec3d logarithm = table[step] + (place - step) * (table[step + 1] - table[step]);
    return {std::exp(logarithm[0]), std::exp(logarithm[1]), std::exp(logarithm[2])};
}

}  // namespace bandvox
