#include "outline/patches/border_curves.h"

#include "outline/patches/line_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox {
namespace {

// The corner-to-corner direction in which the border of the unit square, counter-clockwise, goes
// along a side: 1 if with its parameter.
int turnOf(int side) {
    return side == 1 || side == 2 ? 1 : -1;
}

/// Draws sides, whole or in part.
class SideSampler {
  public:
    SideSampler(std::span<const ViewPatch> seen, const CurveSampling& sampling)
        : mSeen(seen), mSampling(sampling) {}

    Curve sample(const PatchSide& side, double t0, double t1, OutlineKind kind) const {
        Curve curve{.kind = kind, .object = mSeen[static_cast<std::size_t>(side.patch)].object};
        const CurvePoint first = at(side, t0);
        curve.points.push_back(first);
        const auto place = [&](double t) { return at(side, t); };
        LineSampler(place, mSampling).refine({t0, t1}, first, at(side, t1), 0, curve.points);
        return curve;
    }

    CurvePoint at(const PatchSide& side, double t) const {
        const auto [u, v] = onSide(side.side, t);
        const ViewPoint p = mSeen[static_cast<std::size_t>(side.patch)].at(u, v);
        double tx = side.side < 2 ? p.xv : p.xu, ty = side.side < 2 ? p.yv : p.yu;
        const double length = std::hypot(tx, ty);
        if (length > 0) {
            tx /= length;
            ty /= length;
        } else {
            tx = 1;
        }
        return {.x = p.x,
                .y = p.y,
                .z = p.z,
                .tx = tx,
                .ty = ty,
                .patch = side.patch,
                .u = u,
                .v = v,
                .rule = CurveRule::Border};
    }

  private:
    std::span<const ViewPatch> mSeen;
    CurveSampling mSampling;
};

double foldSign(const ViewPatch& patch, int side, double t) {
    const auto [u, v] = onSide(side, t);
    return evaluate(patch.f, u, v).value;
}

std::array<double, 3> unitNormal(const BezierPatch& patch, int side, double t) {
    const auto [u, v] = onSide(side, t);
    const PatchJet jet = evaluate(patch, u, v);
    const auto& a = jet.du;
    const auto& b = jet.dv;
    std::array<double, 3> n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                            a[0] * b[1] - a[1] * b[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    for (double& c : n) c = length > 0 ? c / length : 0;
    return n;
}

class BorderWork {
  public:
    BorderWork(std::span<const BezierPatch> patches, std::span<const ViewPatch> seen,
               std::span<const Curve> folds, const CurveSampling& sampling)
        : mPatches(patches), mSeen(seen), mSampler(seen, sampling), mEnds(seen.size()) {
        for (const Curve& fold : folds) {
            if (fold.closed) continue;
            for (const CurvePoint* p : {&fold.points.front(), &fold.points.back()}) {
                for (int side = 0; side < 4; ++side) {
                    const double across = side < 2 ? p->u : p->v;
                    const double border = side % 2 == 0 ? 0 : 1;
                    if (across != border) continue;
                    mEnds[static_cast<std::size_t>(p->patch)][static_cast<std::size_t>(side)]
                        .push_back(side < 2 ? p->v : p->u);
                }
            }
        }
    }

    BorderCurves work(std::span<const SharedSide> sides, double crease) {
        BorderCurves curves;
        for (const SharedSide& side : sides) {
            if (!side.b) {
                curves.boundaries.push_back(mSampler.sample(side.a, 0, 1, OutlineKind::Boundary));
                continue;
            }
            if (side.isCrowded) {
                curves.creases.push_back(mSampler.sample(side.a, 0, 1, OutlineKind::Crease));
            } else {
                workShared(side, isCrease(side, crease), curves);
            }
        }
        return curves;
    }

  private:
    const ViewPatch& seenAt(const PatchSide& side) const {
        return mSeen[static_cast<std::size_t>(side.patch)];
    }

    static double onB(const SharedSide& side, double t) { return side.reversed ? 1 - t : t; }

    // 1 if both patches are oriented alike, -1 otherwise.
    static int orientation(const SharedSide& side) {
        return turnOf(side.a.side) * turnOf(side.b->side) * (side.reversed ? -1 : 1) < 0 ? 1 : -1;
    }

    bool isCrease(const SharedSide& side, double crease) const {
        for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
            const auto a =
                unitNormal(mPatches[static_cast<std::size_t>(side.a.patch)], side.a.side, t);
            const auto b = unitNormal(mPatches[static_cast<std::size_t>(side.b->patch)],
                                      side.b->side, onB(side, t));
            const double length = std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]);
            const double cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * orientation(side);
            if (length > 0.5 && cosine < crease) return true;
        }
        return false;
    }

    void workShared(const SharedSide& side, bool isCrease, BorderCurves& curves) const {
        std::vector<double> breaks{0, 1};
        for (const double t : endsAt(side.a)) breaks.push_back(t);
        for (const double t : endsAt(*side.b)) breaks.push_back(onB(side, t));
        std::sort(breaks.begin(), breaks.end());
        const bool canFold = seenAt(side.a).hasFold && seenAt(*side.b).hasFold;
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
            const double t0 = breaks[i], t1 = breaks[i + 1];
            if (t0 == t1) continue;
            const double t = 0.5 * (t0 + t1);
            const double a = foldSign(seenAt(side.a), side.a.side, t);
            const double b = foldSign(seenAt(*side.b), side.b->side, onB(side, t));
            if (canFold && a * b * orientation(side) < 0) {
                curves.contours.push_back(mSampler.sample(side.a, t0, t1, OutlineKind::Contour));
            } else if (isCrease) {
                curves.creases.push_back(mSampler.sample(side.a, t0, t1, OutlineKind::Crease));
            }
        }
    }

    const std::vector<double>& endsAt(const PatchSide& side) const {
        return mEnds[static_cast<std::size_t>(side.patch)][static_cast<std::size_t>(side.side)];
    }

    std::span<const BezierPatch> mPatches;
    std::span<const ViewPatch> mSeen;
    SideSampler mSampler;
    std::vector<std::array<std::vector<double>, 4>> mEnds;  // of folds, on each side
};

}  // namespace

BorderCurves borderCurves(std::span<const BezierPatch> patches, std::span<const ViewPatch> seen,
                          std::span<const SharedSide> sides, std::span<const Curve> folds,
                          double crease, const CurveSampling& sampling) {
    return BorderWork(patches, seen, folds, sampling).work(sides, crease);
}

}  // namespace bandvox
