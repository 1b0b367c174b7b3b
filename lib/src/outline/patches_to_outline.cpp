#include "outline/border_curves.h"
#include "outline/fit_cubics.h"
#include "outline/fold_curves.h"
#include "outline/join_curves.h"
#include "outline/meeting_curves.h"
#include "outline/sheets.h"
#include "outline/visible_pieces.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/outline/patches_to_outline.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
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

// Points that are framed: of the surfaces, not of their control nets, which are larger.
std::vector<openvdb::Vec3d> framedPoints(const std::vector<BezierPatch>& patches) {
    constexpr int kSteps = 8;
    std::vector<openvdb::Vec3d> points;
    for (const BezierPatch& patch : patches) {
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; j <= kSteps; ++j) {
                const auto p = evaluate(patch, double(i) / kSteps, double(j) / kSteps).position;
                points.emplace_back(p[0], p[1], p[2]);
            }
        }
    }
    return points;
}

// The view as a map to the page. What is at the edge of the film lies at the edge of what the
// margin leaves.
ViewMatrix viewOf(const Camera& camera, const OutlineOptions& options) {
    const openvdb::math::Mat4d screen = camera.worldToScreen();
    const double wide = 0.5 * options.width - options.margin;
    const double high = 0.5 * options.height - options.margin;
    ViewMatrix view{};
    const bool isPerspective = camera.projection() == CameraOptions::Projection::Perspective;
    for (int c = 0; c < 4; ++c) {
        const auto k = static_cast<std::size_t>(c);
        view[3][k] = screen(c, 3);
        view[0][k] = wide * screen(c, 0) + 0.5 * options.width * screen(c, 3);
        view[1][k] = -high * screen(c, 1) + 0.5 * options.height * screen(c, 3);
        view[2][k] = isPerspective ? (c == 3 ? -1 : 0) : screen(c, 2);
    }
    return view;
}

double rowTimes(const std::array<double, 4>& row, const std::array<double, 4>& p) {
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3];
}

// Scales depths so that they span as much as the page does. Turns the view by a trifle, so that
// nothing is seen exactly edge-on, or from its axis: contours move by its square.
void settle(ViewMatrix& view, const std::vector<BezierPatch>& patches, double size) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const BezierPatch& patch : patches) {
        for (const auto& p : patch.control) {
            const double w = rowTimes(view[3], p);
            if (!(w > 0)) {
                throw Error(ErrorKind::Usage,
                            "a surface reaches behind the eye; expected all of it before the eye: "
                            "an eye that is farther away, or an orthographic view");
            }
            const double depth = rowTimes(view[2], p) / w;
            low = std::min(low, depth);
            high = std::max(high, depth);
        }
    }
    const double scale = size / std::max(high - low, 1e-9 * std::max(std::abs(high), 1e-300));
    const double middle = 0.5 * (low + high);
    constexpr double kTurnX = 2.3e-7, kTurnY = 1.7e-7;
    for (std::size_t c = 0; c < 4; ++c) {
        view[2][c] = scale * (view[2][c] - middle * view[3][c]);
        view[0][c] += kTurnX * view[2][c];
        view[1][c] += kTurnY * view[2][c];
    }
}

void requireFinite(const PatchModel& model) {
    for (const BezierPatch& patch : model.patches) {
        for (const auto& p : patch.control) {
            const bool isGood = std::isfinite(p[0] + p[1] + p[2]) && p[3] > 0 && std::isfinite(p[3]);
            if (isGood) continue;
            std::ostringstream message;
            message << "a patch has the control point (" << p[0] << ", " << p[1] << ", " << p[2]
                    << ") of weight " << p[3] << "; expected finite ones of weights above 0";
            throw Error(ErrorKind::Input, message.str());
        }
    }
}

/// Goes from patches to lines.
class OutlineWork {
  public:
    OutlineWork(const PatchModel& model, const OutlineOptions& options, Progress& progress)
        : mModel(model), mOptions(options), mProgress(progress) {
        mSampling.size = std::max(options.width, options.height);
        mSampling.flatness = std::min(0.25 * options.tolerance, 1e-4 * mSampling.size);
        // The camera's pixels only serve for the shape of the picture.
        const double wide = options.width - 2 * options.margin;
        const double high = options.height - 2 * options.margin;
        const double pixels = 20000 / std::max(wide, high);
        const Camera camera(options.camera, static_cast<int>(std::ceil(pixels * wide)),
                            static_cast<int>(std::ceil(pixels * high)),
                            framedPoints(model.patches));
        ViewMatrix view = viewOf(camera, options);
        settle(view, model.patches, mSampling.size);
        mSeen.resize(model.patches.size());
        parallelFor(static_cast<std::int64_t>(mSeen.size()), [&](std::int64_t i) {
            const auto k = static_cast<std::size_t>(i);
            mSeen[k] = seenBy(view, model.patches[k], mSampling.size);
        });
    }

    Outline work() {
        const std::vector<Curve> curves = allCurves();
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
        return {mOptions.width, mOptions.height, mModel.objects, std::move(paths),
                mModel.warnings};
    }

  private:
    std::vector<Curve> allCurves() const {
        std::vector<std::vector<Curve>> perPatch(mSeen.size());
        parallelFor(static_cast<std::int64_t>(mSeen.size()), [&](std::int64_t i) {
            mProgress.throwIfInterrupted();
            const auto k = static_cast<std::size_t>(i);
            perPatch[k] = foldCurves(mSeen[k], static_cast<int>(i), mSampling);
        });
        std::vector<Curve> folds;
        for (auto& some : perPatch) std::move(some.begin(), some.end(), std::back_inserter(folds));
        const double crease = std::cos(mOptions.creaseAngle * std::numbers::pi / 180);
        BorderCurves borders = borderCurves(mModel.patches, mSeen, folds, crease, mSampling);
        std::move(borders.contours.begin(), borders.contours.end(), std::back_inserter(folds));
        std::vector<Curve> meetings;
        if (mOptions.intersections) {
            meetings = meetingCurves(mSeen, mSampling, mProgress);
        }
        std::vector<Curve> curves;
        for (auto* kind : {&folds, &borders.boundaries, &borders.creases, &meetings}) {
            std::vector<Curve> joined = joinCurves(std::move(*kind), mSampling);
            std::move(joined.begin(), joined.end(), std::back_inserter(curves));
        }
        return curves;
    }

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
    return OutlineWork(model, options, progress).work();
}

}  // namespace bandvox
