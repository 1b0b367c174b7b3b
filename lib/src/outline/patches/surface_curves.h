#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/view_patch.h"

#include <bandvox/core/progress.h>
#include <bandvox/outline/patches_to_outline.h>

#include <span>
#include <vector>

namespace bandvox {

/// All curves that a drawing of patches may show, seen or hidden, joined across their sides.
std::vector<Curve> surfaceCurves(std::span<const BezierPatch> patches,
                                 std::span<const ViewPatch> seen, const OutlineOptions& options,
                                 const CurveSampling& sampling, Progress& progress);

}  // namespace bandvox
