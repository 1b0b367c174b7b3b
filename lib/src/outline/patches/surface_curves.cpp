#include "outline/patches/surface_curves.h"

#include "outline/drawing/join_curves.h"
#include "outline/patches/border_curves.h"
#include "outline/patches/fold_curves.h"
#include "outline/patches/meeting_curves.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace bandvox {

std::vector<Curve> surfaceCurves(std::span<const BezierPatch> patches,
                                 std::span<const ViewPatch> seen, const OutlineOptions& options,
                                 const CurveSampling& sampling, Progress& progress) {
    std::vector<std::vector<Curve>> perPatch(seen.size());
    parallelFor(static_cast<std::int64_t>(seen.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const auto k = static_cast<std::size_t>(i);
        perPatch[k] = foldCurves(seen[k], static_cast<int>(i), sampling);
    });
    std::vector<Curve> folds;
    for (auto& some : perPatch) std::move(some.begin(), some.end(), std::back_inserter(folds));
    const double crease = std::cos(options.creaseAngle * std::numbers::pi / 180);
    const std::vector<SharedSide> sides = matchSides(patches, seen);
    BorderCurves borders = borderCurves(patches, seen, sides, folds, crease, sampling);
    std::move(borders.contours.begin(), borders.contours.end(), std::back_inserter(folds));
    std::vector<Curve> meetings;
    if (options.intersections) meetings = meetingCurves(seen, sides, sampling, progress);
    std::vector<Curve> curves;
    for (auto* kind : {&folds, &borders.boundaries, &borders.creases, &meetings}) {
        std::vector<Curve> joined = joinCurves(std::move(*kind), sampling);
        std::move(joined.begin(), joined.end(), std::back_inserter(curves));
    }
    return curves;
}

}  // namespace bandvox
