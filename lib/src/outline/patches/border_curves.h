#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/shared_sides.h"
#include "outline/patches/view_patch.h"

#include <bandvox/source/bezier_patch.h>

#include <span>
#include <vector>

namespace bandvox {

/// What the sides of patches give to a drawing.
struct BorderCurves {
    std::vector<Curve> boundaries;  ///< sides that no other patch shares
    std::vector<Curve> creases;     ///< shared sides where the surface has an edge
    /// The parts of shared sides where one patch faces the eye and the other one does not: they
    /// belong to the contour as well as the folds, which end there.
    std::vector<Curve> contours;
};

/// `crease`: cosine of the least angle between normals that makes a crease. `folds`: those of all
/// patches.
BorderCurves borderCurves(std::span<const BezierPatch> patches, std::span<const ViewPatch> seen,
                          std::span<const SharedSide> sides, std::span<const Curve> folds,
                          double crease, const CurveSampling& sampling);

}  // namespace bandvox
