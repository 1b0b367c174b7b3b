#include "outline/drawing/draw_curves.h"

#include "outline/drawing/fit_cubics.h"
#include "outline/drawing/visible_pieces.h"
#include "outline/fills/seen_regions.h"

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

void requireTones(const std::vector<double>& tones) {
    constexpr std::size_t kMost = 64;
    if (tones.empty() || tones.size() > kMost) {
        refuseOption("number of tones' cosines", static_cast<double>(tones.size()), "1 to 64");
    }
    double before = -1;
    for (const double tone : tones) {
        if (!(tone > before && tone < 1)) {
            refuseOption("tone's cosine", tone, "between -1 and 1, above the one before");
        }
        before = tone;
    }
}

// Whether a piece is to be a line, rather than to tell regions apart only.
bool isDrawn(const Curve& curve, const CurveScene& scene, const OutlineOptions& options) {
    if (!curve.isDrawn) return false;
    if (curve.kind == OutlineKind::Intersection) return options.intersections;
    if (curve.kind != OutlineKind::Isophote) return true;
    const CurvePoint& middle = curve.points[curve.points.size() / 2];
    const auto& wanted = options.isophotes;
    if (std::find(wanted.begin(), wanted.end(), middle.t) == wanted.end()) return false;
    // A patch has the curve of the opposite cosine, too: there its other side has the wanted one.
    return isOfVolume(middle.rule) || scene.reader()->cosineAt(middle) * middle.t >= 0;
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
    constexpr double kLeastTolerance = 1e-9;  // of the page: curves are not known better
    const double least = kLeastTolerance * std::max(options.width, options.height);
    if (!(options.tolerance >= least) || !std::isfinite(options.tolerance)) {
        refuseOption("tolerance", options.tolerance,
                     "a billionth of the page's longer side or more");
    }
    if (!(options.creaseAngle >= 0 && options.creaseAngle <= 180)) {
        refuseOption("crease angle", options.creaseAngle, "0 to 180 degrees");
    }
    for (const double cosine : options.isophotes) {
        if (!(std::abs(cosine) < 1)) refuseOption("isophote", cosine, "between -1 and 1");
    }
    if (options.suggestive && !(*options.suggestive >= 0)) {
        refuseOption("suggestive contours' strength", *options.suggestive, "0 or more");
    }
    if (options.fill == OutlineFillKind::Toon) requireTones(options.tones);
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

std::vector<double> allIsophotes(const OutlineOptions& options) {
    std::vector<double> cosines = options.isophotes;
    if (options.fill == OutlineFillKind::Toon) {
        cosines.insert(cosines.end(), options.tones.begin(), options.tones.end());
    }
    std::sort(cosines.begin(), cosines.end());
    cosines.erase(std::unique(cosines.begin(), cosines.end()), cosines.end());
    return cosines;
}

Outline drawCurves(std::span<const Curve> curves, const CurveScene& scene,
                   const OutlineOptions& options, Progress& progress) {
    const auto pieces = visiblePieces(curves, scene, samplingFor(options), progress);
    std::vector<OutlinePath> paths(pieces.size());
    parallelFor(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        const auto& [curve, hidden] = pieces[k];
        if ((hidden > 0 && !options.hidden) || !isDrawn(curve, scene, options)) return;
        paths[k] = {curve.kind, curve.object, hidden, curve.closed,
                    fitCubics(curve, options.tolerance)};
    });
    std::erase_if(paths, [](const OutlinePath& path) { return path.points.size() < 4; });
    Outline outline{options.width, options.height, {}, std::move(paths)};
    if (options.fill != OutlineFillKind::None) {
        outline.fills = seenRegions(pieces, scene, options, progress);
        const bool isToon = options.fill == OutlineFillKind::Toon;
        outline.tones = isToon ? static_cast<int>(options.tones.size()) + 1 : 1;
    }
    if (outline.paths.empty() && outline.fills.empty()) {
        throw Error(ErrorKind::Result,
                    "the drawing is empty: nothing of the surfaces has a line to draw");
    }
    return outline;
}

}  // namespace bandvox
