#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/drawing/visible_pieces.h"

#include <span>
#include <vector>

namespace bandvox {

/// Joins the ends of lines that are seen to what they end on, so that no gap is left between:
/// ends that are nearer to each other than twice the curves' flatness get one place, and a line
/// that passes there gets a point there. What is farther than that, by up to 5e-4 of the page, is
/// bridged.
std::vector<Curve> weldedCurves(std::span<const VisiblePiece> pieces, const CurveScene& scene,
                                const CurveSampling& sampling);

}  // namespace bandvox
