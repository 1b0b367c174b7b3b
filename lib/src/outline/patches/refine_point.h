#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/view_patch.h"

#include <span>

namespace bandvox {

/// The exact point of a curve between two that follow each other, at a share of the way, 0 to 1.
CurvePoint pointBetween(std::span<const ViewPatch> patches, const CurvePoint& a,
                        const CurvePoint& b, double share);

/// Sets where the view sees a point of an intersection, and its direction, by its parameters.
void placeMeeting(std::span<const ViewPatch> patches, CurvePoint& point);

}  // namespace bandvox
