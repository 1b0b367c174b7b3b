#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/view_patch.h"

#include <vector>

namespace bandvox {

/// The curves on which `patch.f` is 0, from side to side or closed. `rule`: what their points
/// follow; those of folds turn back at cusps, which are corners.
std::vector<Curve> zeroCurves(const ViewPatch& patch, int index, CurveRule rule,
                              const CurveSampling& sampling);

/// The curves F = 0 of a patch, from side to side or closed, with their cusps as corners.
std::vector<Curve> foldCurves(const ViewPatch& patch, int index, const CurveSampling& sampling);

}  // namespace bandvox
