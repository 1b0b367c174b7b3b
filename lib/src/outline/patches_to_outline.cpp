#include "outline/drawing/draw_curves.h"
#include "outline/drawing/page_view.h"
#include "outline/patches/patch_scene.h"
#include "outline/patches/surface_curves.h"

#include <bandvox/core/error.h>
#include <bandvox/outline/patches_to_outline.h>

#include <algorithm>

namespace bandvox {
namespace {

std::array<double, 3> place(const std::array<double, 4>& p) {
    return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
}

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
    const CurveSampling sampling = samplingFor(options);
    const ViewMatrix view = pageView(model.patches, options);
    const std::vector<ViewPatch> seen = seenBy(view, model.patches, sampling.size);
    const FaceRegions faces(model.topology);
    const LitPatches lit{model.patches, seen, lightDirection(contentOf(model.patches), options),
                         model.topology.faces.empty() ? nullptr : &faces};
    const std::vector<Curve> curves = surfaceCurves(lit, options, sampling, progress);
    Outline outline = drawCurves(curves, PatchScene(lit, sampling.size), options, progress);
    outline.objects = model.objects;
    outline.warnings = model.warnings;
    return outline;
}

}  // namespace bandvox
