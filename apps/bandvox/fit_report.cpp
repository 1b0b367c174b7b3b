#include "fit_report.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <nlohmann/json.hpp>

#include <cstdint>

namespace bandvox::app {

void sayPoints(CommandRun& run, const std::string& input, const ScatteredPoints& points) {
    run.say("read     " + input + ": " +
            formatCount(static_cast<std::int64_t>(points.size()), "point", "points") + " with " +
            joined(points.names, ", "));
}

void sayDuplicates(CommandRun& run, std::size_t points, std::size_t duplicates) {
    run.count("points", points);
    run.count("duplicates", duplicates);
    if (duplicates == 0) return;
    run.say("         " +
            formatCount(static_cast<std::int64_t>(duplicates), "point was", "points were") +
            " in the place of another, and averaged");
}

void judgeResidual(CommandRun& run, const FitResidual& residual) {
    if (residual.largest <= residual.expected) return;
    std::string message = "the " + residual.what + " is off by ";
    message += formatNumber(residual.largest, 3) + " of the range at a point; expected ";
    message += formatNumber(residual.expected, 3) + " at most, by --tolerance";
    // As where a crowd of points and one far away share a net: what is between them is anything.
    constexpr double kUseless = 0.01;
    const bool isUseless = !residual.isLimited && !(residual.largest <= kUseless);
    if (residual.isAsked || isUseless) throw Error(ErrorKind::Result, message);
    run.warn({message}, ErrorKind::Result);
}

}  // namespace bandvox::app
