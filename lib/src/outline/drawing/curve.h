#pragma once

#include <bandvox/outline/outline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bandvox {

/// What keeps a curve's points on it between two known ones.
enum class CurveRule {
    Fold,            ///< F = 0 on the patch
    Border,          ///< a straight line of the patch's parameters
    Meeting,         ///< in two patches
    Isophote,        ///< of one angle to the light on a patch
    Edge,            ///< an edge of a face
    Piercing,        ///< on a patch where it passes through the surface of a volume
    VolumeFold,      ///< ∇f~·v = 0 on a volume's surface
    VolumeMeeting,   ///< in the surfaces of two volumes
    VolumeIsophote,  ///< of one angle to the light on a volume's surface
    Suggestive,      ///< without curvature along the line of sight on a volume's surface
};

/// Whether a rule is one of volumes alone.
inline bool isOfVolume(CurveRule rule) {
    return rule >= CurveRule::VolumeFold;
}

/// A point of a curve on patches, where the view sees it. Of a curve on a volume's surface `patch`
/// is the number of that volume, `other` that of the other one of an intersection, (u, v, s) the
/// place in index coordinates; where a patch passes through a volume `other` is the volume's. Of an
/// isophote t is the cosine that makes it. Of an edge `other` is the number of its piece, s the
/// parameter along that.
struct CurvePoint {
    double x = 0, y = 0, z = 0;  ///< on the page, and depth
    double tx = 1, ty = 0;       ///< direction of the curve on the page, length 1, without a sign
    int patch = -1;              ///< on which it lies, at (u, v)
    double u = 0, v = 0;
    int other = -1;  ///< the other patch of an intersection, at (s, t)
    double s = 0, t = 0;
    CurveRule rule = CurveRule::Fold;
    bool corner = false;  ///< the curve turns sharply or back: at a cusp, at a kink
};

/// A curve as a chain of exact points, dense enough to be straight between them. Two that follow
/// each other are on the same patches by the same rule, or in the same place.
struct Curve {
    OutlineKind kind = OutlineKind::Contour;
    bool closed = false;  ///< the last point is the first one again
    int object = 0;
    bool isDrawn = true;  ///< false: it only tells regions apart
    std::vector<CurvePoint> points;
};

/// How far the curve between two points leaves their chord, as an arc would with the larger of the
/// angles between the chord and the directions there: tells of an inflection between them, too.
inline double bowBetween(const CurvePoint& a, const CurvePoint& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    return 0.25 * std::max(std::abs(dx * a.ty - dy * a.tx), std::abs(dx * b.ty - dy * b.tx));
}

/// How densely curves are sampled.
struct CurveSampling {
    double flatness = 1e-3;  ///< largest distance from the chord, page units
    double size = 1;         ///< of the page
};

}  // namespace bandvox
