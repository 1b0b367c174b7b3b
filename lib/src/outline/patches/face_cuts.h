#pragma once

#include "outline/drawing/curve.h"
#include "source/face_regions.h"

#include <functional>
#include <vector>

namespace bandvox {

/// The exact point of a curve between two that follow each other, at a share of the way.
using PointBetween =
    std::function<CurvePoint(const CurvePoint& a, const CurvePoint& b, double share)>;

/// The parts of curves that belong to the faces that their patches do; of intersections to both.
/// Each curve is on one patch, or pair of patches. Ends are within 1e-12 of the way from one point
/// to the next. What runs along a loop, nearer to it than about 1/1000 of that way, belongs to the
/// face. Null faces cut nothing.
std::vector<Curve> cutToFaces(std::vector<Curve> curves, const FaceRegions* faces,
                              const PointBetween& between);

}  // namespace bandvox
