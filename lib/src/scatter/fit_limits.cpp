#include "scatter/fit_limits.h"

#include <bandvox/core/error.h>

#include <cmath>
#include <string>

namespace bandvox {

void checkFitLimits(const FitLimits& limits) {
    const auto fail = [&](const std::string& name, double found, const std::string& expected) {
        std::string message = name + " of " + limits.what;
        message += " is " + std::to_string(found);
        message += "; expected " + expected;
        throw Error(ErrorKind::Usage, message);
    };
    if (!(limits.tolerance >= 0 && limits.tolerance <= 1)) {
        fail("the tolerance", limits.tolerance, "0 to 1");
    }
    if (!(limits.noise >= 0 && std::isfinite(limits.noise))) {
        fail("the noise", limits.noise, "0 or more");
    }
    if (limits.maxLevel && (*limits.maxLevel < 1 || *limits.maxLevel > limits.finest)) {
        fail("the finest level", *limits.maxLevel, "1 to " + std::to_string(limits.finest));
    }
    if (limits.tension && !(*limits.tension >= 0.01 && *limits.tension <= 1e4)) {
        fail("the tension", *limits.tension, "0.01 to 10000");
    }
}

}  // namespace bandvox
