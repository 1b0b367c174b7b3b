#pragma once

#include <bandvox/scatter/scattered_points.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

// Points and functions that methods for scattered data are measured with.
namespace bandvox::scatter_test {

using PlaneFunction = std::function<double(double, double)>;

inline double square(double x) {
    return x * x;
}

/// G. Nielson, "A Method for Interpolating Scattered Data Based Upon a Minimum Norm Network", 1983.
inline double bump(double x, double y) {
    return 0.25 * std::exp(-16 * (square(x - 0.5) + square(y - 0.5)));
}

/// R. Franke, "A Critical Comparison of Some Methods for Interpolation of Scattered Data", 1979.
inline std::vector<PlaneFunction> frankeFunctions() {
    const auto peak = [](double width) {
        return [width](double x, double y) {
            return std::exp(-width * (square(x - 0.5) + square(y - 0.5))) / 3;
        };
    };
    return {[](double x, double y) {
                return 0.75 * std::exp(-(square(9 * x - 2) + square(9 * y - 2)) / 4) +
                       0.75 * std::exp(-square(9 * x + 1) / 49 - (9 * y + 1) / 10) +
                       0.5 * std::exp(-(square(9 * x - 7) + square(9 * y - 3)) / 4) -
                       0.2 * std::exp(-square(9 * x - 4) - square(9 * y - 7));
            },
            [](double x, double y) { return (std::tanh(9 * y - 9 * x) + 1) / 9; },
            [](double x, double y) {
                return (1.25 + std::cos(5.4 * y)) / (6 * (1 + square(3 * x - 1)));
            },
            peak(81.0 / 16),
            peak(81.0 / 4),
            [](double x, double y) {
                return std::sqrt(64 - 81 * (square(x - 0.5) + square(y - 0.5))) / 9 - 0.5;
            }};
}

using Places = std::vector<std::pair<double, double>>;

/// What numpy.random.RandomState(seed).random_sample((count, 2)) gives.
inline Places randomPlaces(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    const auto next = [&] {
        const double high = generator() >> 5U;
        const double low = generator() >> 6U;
        return (high * 67108864.0 + low) / 9007199254740992.0;
    };
    Places places(count);
    for (auto& [x, y] : places) {
        x = next();
        y = next();
    }
    return places;
}

/// Franke's 100 and 33 places and C. L. Lawson's 25, as in ACM TOMS algorithm 792.
const Places& franke100();
const Places& franke33();
const Places& lawson25();

inline ScatteredPoints sampled(const Places& places, const PlaneFunction& f) {
    ScatteredPoints points;
    for (const auto& [x, y] : places) {
        points.x.push_back(x);
        points.y.push_back(y);
        points.values.push_back(f(x, y));
    }
    return points;
}

/// True if a place is in the convex hull of others, its border included.
bool isInHull(const Places& places, double x, double y);

}  // namespace bandvox::scatter_test
