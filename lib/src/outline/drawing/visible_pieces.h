#pragma once

#include "outline/drawing/curve_scene.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// A part of a curve, and how many surfaces are in front of all of it.
struct VisiblePiece {
    Curve curve;
    int hidden = 0;
};

/// Cuts curves where the number of surfaces in front of them changes. Each part is certified by
/// lines of sight to the surfaces themselves, three or more; where these differ, the change is
/// searched for and is a cut, too.
std::vector<VisiblePiece> visiblePieces(std::span<const Curve> curves, const CurveScene& scene,
                                        const CurveSampling& sampling, Progress& progress);

}  // namespace bandvox
