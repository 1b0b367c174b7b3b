#include "outline/fit_cubics.h"
#include "outline/page_view.h"
#include "outline/sheets.h"
#include "outline/surface_curves.h"
#include "outline/visible_pieces.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/outline/patches_to_outline.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bandvox {
namespace {

void refuseOption(const char* what, double found, const char* expected) {
    std::ostringstream message;
    message << "the outline's " << what << " is " << found << "; it must be " << expected;
    throw Error(ErrorKind::Usage, message.str());
}

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

std::array<double, 3> place(const std::array<double, 4>& p) {
    return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
}

/// Goes from patches to lines.
class OutlineWork {
  public:
    OutlineWork(const PatchModel& model, const OutlineOptions& options, Progress& progress)
        : mModel(model), mOptions(options), mProgress(progress) {
        mSampling.size = std::max(options.width, options.height);
        mSampling.flatness = std::min(0.25 * options.tolerance, 1e-4 * mSampling.size);
        const ViewMatrix view = pageView(model.patches, options);
        mSeen.resize(model.patches.size());
        parallelFor(static_cast<std::int64_t>(mSeen.size()), [&](std::int64_t i) {
            const auto k = static_cast<std::size_t>(i);
            mSeen[k] = seenBy(view, model.patches[k], mSampling.size);
        });
    }

    Outline work() {
        const std::vector<Curve> curves =
            surfaceCurves(mModel.patches, mSeen, mOptions, mSampling, mProgress);
        const Sheets sheets(mSeen);
        const auto pieces = visiblePieces(curves, mSeen, sheets, mSampling, mProgress);
        std::vector<OutlinePath> paths(pieces.size());
        parallelFor(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
            const auto k = static_cast<std::size_t>(i);
            const auto& [curve, hidden] = pieces[k];
            if (hidden > 0 && !mOptions.hidden) return;
            paths[k] = {curve.kind, curve.object, hidden, curve.closed,
                        fitCubics(curve, mOptions.tolerance)};
        });
        std::erase_if(paths, [](const OutlinePath& path) { return path.points.size() < 4; });
        if (paths.empty()) {
            throw Error(ErrorKind::Result,
                        "the drawing is empty: nothing of the surfaces has a line to draw");
        }
        return {mOptions.width, mOptions.height, mModel.objects, std::move(paths), mModel.warnings};
    }

  private:
    const PatchModel& mModel;
    const OutlineOptions& mOptions;
    Progress& mProgress;
    CurveSampling mSampling;
    std::vector<ViewPatch> mSeen;
};

}  // namespace

Outline patchesToOutline(const PatchModel& model, const OutlineOptions& options,
                         Progress& progress) {
    requireValid(options);
    requireFinite(model);
    if (model.patches.empty()) {
        throw Error(ErrorKind::Result, "the drawing is empty: there are no surfaces");
    }
    const auto isFirst = [&, first = place(model.patches[0].control[0])](const auto& p) {
        return place(p) == first;
    };
    const bool isOnePoint =
        std::all_of(model.patches.begin(), model.patches.end(), [&](const BezierPatch& patch) {
            return std::all_of(patch.control.begin(), patch.control.end(), isFirst);
        });
    if (isOnePoint) {
        throw Error(ErrorKind::Result, "the drawing is empty: all surfaces are one point");
    }
    return OutlineWork(model, options, progress).work();
}

}  // namespace bandvox
