#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/view_patch.h"

#include <vector>

namespace bandvox {

/// The curves F = 0 of a patch, from side to side or closed, with their cusps as corners.
std::vector<Curve> foldCurves(const ViewPatch& patch, int index, const CurveSampling& sampling);

}  // namespace bandvox
