#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/vectors.h"
#include "outline/patches/view_patch.h"
#include "source/face_regions.h"

#include <bandvox/source/bezier_patch.h>

#include <span>
#include <vector>

namespace bandvox {

/// Patches, as they are and as the page sees them, and a light.
struct LitPatches {
    std::span<const BezierPatch> patches;
    std::span<const ViewPatch> seen;     ///< one for each
    Vec light{};                         ///< direction to it, world, length 1
    const FaceRegions* faces = nullptr;  ///< none: no patch is a part of a face
};

/// The cosine of the angle between the light and the normal that faces the eye; 0 where a patch
/// has no normal.
double lightCosine(const LitPatches& lit, int patch, double u, double v);

/// The curves of a patch on which the normal n, on either side, and the light l are at one angle:
/// (n·l)² = c² n·n with n = S_u × S_v, a polynomial equation, of which nothing is missed.
/// `cosine`: c, between -1 and 1.
std::vector<Curve> isophoteCurves(const LitPatches& lit, int patch, double cosine,
                                  const CurveSampling& sampling);

/// The exact point of an isophote between two of its points on one patch, at a share of the way.
CurvePoint isophoteBetween(const LitPatches& lit, const CurvePoint& a, const CurvePoint& b,
                           double share);

}  // namespace bandvox
