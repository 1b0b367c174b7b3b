#include "outline/drawing/draw_curves.h"

#include "outline/drawing/fit_cubics.h"
#include "outline/drawing/visible_pieces.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

void refuseOption(const char* what, double found, const char* expected) {
    std::ostringstream message;
    message << "the outline's " << what << " is " << found << "; it must be " << expected;
    throw Error(ErrorKind::Usage, message.str());
}

}  // namespace

void requireValid(const OutlineOptions& options) {
    const double side = std::min(options.width, options.height);
    if (!(side > 0) || !std::isfinite(options.width + options.height)) {
        refuseOption("page's shorter side", side, "above 0");
    }
    if (!(options.margin >= 0 && options.margin < 0.5 * side)) {
        refuseOption("margin", options.margin, "0 or more, and below half of the page");
    }
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) {
        refuseOption("tolerance", options.tolerance, "above 0");
    }
    if (!(options.creaseAngle >= 0 && options.creaseAngle <= 180)) {
        refuseOption("crease angle", options.creaseAngle, "0 to 180 degrees");
    }
    for (const double cosine : options.isophotes) {
        if (!(std::abs(cosine) < 1)) refuseOption("isophote", cosine, "between -1 and 1");
    }
    const double light = options.light.length();
    if (!(light > 0) || !std::isfinite(light)) {
        refuseOption("light's direction's length", light, "above 0");
    }
    requireValid(options.camera);
}

void requireFinite(const PatchModel& model) {
    for (const BezierPatch& patch : model.patches) {
        for (const auto& p : patch.control) {
            const bool isGood =
                std::isfinite(p[0] + p[1] + p[2]) && p[3] > 0 && std::isfinite(p[3]);
            if (isGood) continue;
            std::ostringstream message;
            message << "a patch has the control point (" << p[0] << ", " << p[1] << ", " << p[2]
                    << ") of weight " << p[3] << "; expected finite ones of weights above 0";
            throw Error(ErrorKind::Input, message.str());
        }
    }
}

CurveSampling samplingFor(const OutlineOptions& options) {
    CurveSampling sampling;
    sampling.size = std::max(options.width, options.height);
    sampling.flatness = std::min(0.25 * options.tolerance, 1e-4 * sampling.size);
    return sampling;
}

Outline drawCurves(std::span<const Curve> curves, const CurveScene& scene,
                   const OutlineOptions& options, Progress& progress) {
    const auto pieces = visiblePieces(curves, scene, samplingFor(options), progress);
    std::vector<OutlinePath> paths(pieces.size());
    parallelFor(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        const auto& [curve, hidden] = pieces[k];
        if (hidden > 0 && !options.hidden) return;
        paths[k] = {curve.kind, curve.object, hidden, curve.closed,
                    fitCubics(curve, options.tolerance)};
    });
    std::erase_if(paths, [](const OutlinePath& path) { return path.points.size() < 4; });
    if (paths.empty()) {
        throw Error(ErrorKind::Result,
                    "the drawing is empty: nothing of the surfaces has a line to draw");
    }
    return {options.width, options.height, {}, std::move(paths), {}};
}

}  // namespace bandvox
