#pragma once

#include "outline/curve.h"
#include "outline/view_patch.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// The curves in which patches pass through each other, or through themselves, beyond the sides
/// that they share.
std::vector<Curve> meetingCurves(std::span<const ViewPatch> seen, const CurveSampling& sampling,
                                 Progress& progress);

}  // namespace bandvox
