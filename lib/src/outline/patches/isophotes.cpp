#include "outline/patches/isophotes.h"

#include "outline/patches/bernstein.h"
#include "outline/patches/fold_curves.h"
#include "outline/patches/onto_zero.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bandvox {
namespace {

using Normals = std::array<Bernstein2, 3>;

Bernstein2 scaled(double s, Bernstein2 p) {
    for (double& c : p.c) c *= s;
    return p;
}

// a × b of vectors of polynomials.
Normals crossed(const Normals& a, const Normals& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Where sides are points all normals vanish; what is beside them is told without that factor.
void removeSideFactors(Normals& n) {
    constexpr int kMostFactors = 4;
    constexpr double kRounding = 1e-12;
    const auto largest = [&](const auto& magnitude) {
        return std::max({magnitude(n[0]), magnitude(n[1]), magnitude(n[2])});
    };
    for (int side = 0; side < 4; ++side) {
        for (int k = 0; k < kMostFactors; ++k) {
            const double all = largest([](const Bernstein2& p) { return p.largestMagnitude(); });
            const double there =
                largest([&](const Bernstein2& p) { return sideMagnitude(p, side); });
            const int degree = side < 2 ? n[0].m : n[0].n;
            if (degree == 0 || !(all > 0) || there > kRounding * all) break;
            for (Bernstein2& p : n) p = withoutFactor(p, side);
        }
    }
}

// S_u × S_v times a positive factor. Of S = P / w it is w P_u × P_v + w_v P × P_u - w_u P × P_v,
// divided by w³.
Normals normalsOf(const BezierPatch& patch) {
    std::array<Bernstein2, 4> rows;
    for (std::size_t r = 0; r < 4; ++r) {
        rows[r] = Bernstein2(patch.degreeU, patch.degreeV);
        for (std::size_t k = 0; k < patch.control.size(); ++k) rows[r].c[k] = patch.control[k][r];
    }
    const Bernstein2& w = rows[3];
    const Normals p{rows[0], rows[1], rows[2]};
    const Normals pu{derivativeU(p[0]), derivativeU(p[1]), derivativeU(p[2])};
    const Normals pv{derivativeV(p[0]), derivativeV(p[1]), derivativeV(p[2])};
    Normals n = crossed(pu, pv);
    if (w.smallest() < w.largest()) {
        const Bernstein2 wu = derivativeU(w), wv = derivativeV(w);
        const Normals byV = crossed(p, pu), byU = crossed(p, pv);
        for (std::size_t k = 0; k < 3; ++k) n[k] = w * n[k] + wv * byV[k] - wu * byU[k];
    }
    removeSideFactors(n);
    return n;
}

Bernstein2 isophoteFunction(const BezierPatch& patch, const Vec& light, double cosine) {
    const Normals n = normalsOf(patch);
    Bernstein2 lit = scaled(light[0], n[0]) + scaled(light[1], n[1]) + scaled(light[2], n[2]);
    if (cosine == 0) return lit;
    const Bernstein2 square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    return lit * lit - scaled(cosine * cosine, square);
}

// A normal with its derivatives by u and v.
struct NormalJet {
    Vec n, du, dv;
};

NormalJet normalAt(const BezierPatch& patch, double u, double v) {
    const PatchJet s = evaluate(patch, u, v);
    return {cross(s.du, s.dv), plus(cross(s.duu, s.dv), cross(s.du, s.duv)),
            plus(cross(s.duv, s.dv), cross(s.du, s.dvv))};
}

Gradient2 isophoteAt(const BezierPatch& patch, const Vec& light, double cosine, double u,
                     double v) {
    const auto [n, du, dv] = normalAt(patch, u, v);
    const double lit = dot(n, light);
    if (cosine == 0) return {lit, dot(du, light), dot(dv, light)};
    const double c = cosine * cosine;
    return {lit * lit - c * dot(n, n), 2 * (lit * dot(du, light) - c * dot(n, du)),
            2 * (lit * dot(dv, light) - c * dot(n, dv))};
}

}  // namespace

double lightCosine(const LitPatches& lit, int patch, double u, double v) {
    const auto k = static_cast<std::size_t>(patch);
    // At a side that is a point there is no normal, but beside it.
    constexpr double kBeside = 1e-7;
    const auto inside = [&](double t) { return std::clamp(t, kBeside, 1 - kBeside); };
    const PatchJet jet = evaluate(lit.patches[k], inside(u), inside(v));
    const Vec n = cross(jet.du, jet.dv);
    const double length = lengthOf(n);
    if (!(length > 0)) return 0;
    // On the page x goes right, y down and z away from the eye, a right-handed frame: S_u × S_v
    // points away from the eye where its z, which is F, is positive.
    const ViewPoint p = lit.seen[k].at(inside(u), inside(v));
    const double away = p.xu * p.yv - p.xv * p.yu;
    return (away > 0 ? -1 : 1) * dot(n, lit.light) / length;
}

std::vector<Curve> isophoteCurves(const LitPatches& lit, int patch, double cosine,
                                  const CurveSampling& sampling) {
    const auto k = static_cast<std::size_t>(patch);
    ViewPatch level = lit.seen[k];
    if (!level.hasFold) return {};
    level.f = isophoteFunction(lit.patches[k], lit.light, cosine);
    // A plane has one angle everywhere.
    const double size = level.f.largestMagnitude();
    if (!(size > 0) || level.f.smallest() > 0 || level.f.largest() < 0) return {};
    std::vector<Curve> curves = zeroCurves(level, patch, CurveRule::Isophote, sampling);
    for (Curve& curve : curves) {
        curve.kind = OutlineKind::Isophote;
        for (CurvePoint& p : curve.points) p.t = cosine;
    }
    return curves;
}

CurvePoint isophoteBetween(const LitPatches& lit, const CurvePoint& a, const CurvePoint& b,
                           double share) {
    CurvePoint point = share < 0.5 ? a : b;
    point.corner = false;
    point.u = a.u + share * (b.u - a.u);
    point.v = a.v + share * (b.v - a.v);
    const auto k = static_cast<std::size_t>(a.patch);
    const bool isThere = ontoZero(
        [&](double u, double v) { return isophoteAt(lit.patches[k], lit.light, a.t, u, v); },
        point.u, point.v);
    if (!isThere) return share < 0.5 ? a : b;
    const ViewPoint p = lit.seen[k].at(point.u, point.v);
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    const Gradient2 f = isophoteAt(lit.patches[k], lit.light, a.t, point.u, point.v);
    const double tx = p.xv * f.du - p.xu * f.dv, ty = p.yv * f.du - p.yu * f.dv;
    const double length = std::hypot(tx, ty);
    if (length > 0) {
        point.tx = tx / length;
        point.ty = ty / length;
    }
    return point;
}

}  // namespace bandvox
