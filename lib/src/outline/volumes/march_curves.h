#pragma once

#include "outline/volumes/space_curve.h"

#include <bandvox/core/progress.h>

#include <openvdb/Types.h>

#include <span>
#include <vector>

namespace bandvox {

/// Curves through places that are on them, each curve once, as chains of points that are dense
/// enough to be straight between them on the page; where the image of a curve turns back is a
/// corner. Most are closed. The order of the places decides where a curve begins.
std::vector<Curve> marchCurves(CurveEquations& equations, std::span<const openvdb::Vec3d> places,
                               const CurveSampling& sampling, Progress& progress);

}  // namespace bandvox
