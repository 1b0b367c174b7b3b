#pragma once

#include <optional>

namespace bandvox {

/// What the options of all fits have in common.
struct FitLimits {
    const char* what;             ///< is fitted, as in "the tension of a fit is"
    double tolerance;             ///< parts of the range, 0 to 1
    double noise;                 ///< in the values' unit, 0 or more
    std::optional<int> maxLevel;  ///< 1 to `finest`
    int finest;
    std::optional<double> tension;  ///< 0.01 to 10000
};

/// Throws Error(ErrorKind::Usage) for what is out of range.
void checkFitLimits(const FitLimits& limits);

}  // namespace bandvox
