#include "fit_report.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>

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
    const std::optional<FitFault> fault = faultOf(residual);
    if (!fault) return;
    const std::string message = fault->message + ", by --tolerance";
    if (fault->isError) throw Error(ErrorKind::Result, message);
    run.warn({message}, ErrorKind::Result);
}

}  // namespace bandvox::app
