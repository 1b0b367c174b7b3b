#pragma once

#include <algorithm>
#include <cmath>

namespace bandvox {

/// Samples begin, begin + 1, … end - 1 of a row.
struct SampleRange {
    int begin = 0, end = 0;

    bool contains(int i) const { return i >= begin && i < end; }
};

/// Of samples 0 to count - 1 those in [low, high]; both in samples. What is on an end, to a
/// millionth of a sample, counts in.
inline SampleRange samplesWithin(double low, double high, int count) {
    constexpr double kOnEnd = 1e-6;
    const auto clamped = [count](double at) {
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count)));
    };
    const int begin = clamped(std::ceil(low - kOnEnd));
    return {begin, std::max(begin, clamped(std::floor(high + kOnEnd) + 1))};
}

}  // namespace bandvox
