#include "core/words.h"

#include <bandvox/scatter/fit_residual.h>

namespace bandvox {

std::optional<FitFault> faultOf(const FitResidual& residual) {
    if (residual.largest <= residual.expected) return std::nullopt;
    FitFault fault;
    fault.message = "the " + residual.what + " is off by ";
    fault.message += inShort(residual.largest) + " of the range at a point; expected ";
    fault.message += inShort(residual.expected) + " at most";
    constexpr double kUseless = 0.01;
    const bool isUseless = !residual.isLimited && !(residual.largest <= kUseless);
    fault.isError = residual.isAsked || isUseless;
    return fault;
}

}  // namespace bandvox
