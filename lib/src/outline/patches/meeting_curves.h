#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/shared_sides.h"
#include "outline/patches/view_patch.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// The curves in which patches pass through each other, or through themselves, beyond the sides
/// that they share. Each goes on to a border of a patch, to where it closes, or to where surfaces
/// touch. One that lies as a whole in two regions smaller than 1/5000 of the page may be missed.
/// Patches of one shell of faces are not looked at: these meet in their edges only.
std::vector<Curve> meetingCurves(std::span<const ViewPatch> seen, std::span<const SharedSide> sides,
                                 const FaceRegions* faces, const CurveSampling& sampling,
                                 Progress& progress);

}  // namespace bandvox
