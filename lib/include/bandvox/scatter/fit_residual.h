#pragma once

#include <optional>
#include <string>

namespace bandvox {

/// What a fit leaves at the points, and what was asked for.
struct FitResidual {
    std::string what;        ///< "surface"
    double largest = 0;      ///< left, in parts of the range
    double expected = 0;     ///< the same
    bool isAsked = false;    ///< somebody chose what is expected
    bool isLimited = false;  ///< levels were limited
};

/// What is to be said of a fit that leaves more than is expected.
struct FitFault {
    std::string message;
    bool isError = false;  ///< it is of no use, or not what was asked for; else worth a warning
};

/// Nothing if the fit leaves no more than is expected. A surface that is off by more than 1 % of
/// the range is of no use, unless its levels were limited: between a crowd of points and one far
/// away, say, anything may be.
std::optional<FitFault> faultOf(const FitResidual& residual);

}  // namespace bandvox
