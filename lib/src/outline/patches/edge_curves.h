#pragma once

#include "outline/patches/border_curves.h"
#include "outline/patches/isophotes.h"

#include <span>
#include <vector>

namespace bandvox {

/// What the edges of faces give to a drawing, as sides of patches do. `crease`: cosine of the least
/// angle between normals that makes a crease. `folds`: those of all patches, cut to their faces.
BorderCurves edgeCurves(const LitPatches& lit, std::span<const Curve> folds, double crease,
                        const CurveSampling& sampling);

/// The exact point of an edge between two of its points on one piece, at a share of the way.
CurvePoint edgeBetween(const LitPatches& lit, const CurvePoint& a, const CurvePoint& b,
                       double share);

/// What faces are at a point of an edge, and how far their curves are from each other, in page
/// units: as files have them, they only nearly meet.
struct EdgeFaces {
    std::vector<int> faces;
    double gap = 0;
};
EdgeFaces facesAt(const LitPatches& lit, const CurvePoint& point);

}  // namespace bandvox
