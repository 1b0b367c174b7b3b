#include "outline/patches/fold_curves.h"

#include "outline/patches/fold_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {
namespace {

// A point of a stretch: where it is, and how fast its image goes along the fold's direction.
struct LedPoint {
    double lead = 0, follow = 0;
    double speed = 0;  // signed by the direction in `point`
    CurvePoint point;
};

/// Samples one stretch of a fold.
class StretchSampler {
  public:
    StretchSampler(const ViewPatch& patch, int index, const FoldStretch& stretch, CurveRule rule,
                   const CurveSampling& sampling)
        : mPatch(patch), mIndex(index), mStretch(stretch), mRule(rule), mSampling(sampling) {}

    std::vector<CurvePoint> sample() {
        const LedPoint first = at(mStretch.lead0, mStretch.start);
        mPoints.push_back(first.point);
        refine(first, at(mStretch.lead1, mStretch.end), 0);
        return std::move(mPoints);
    }

  private:
    LedPoint at(double lead, double guess) const {
        const auto [u, v] = mStretch.at(mPatch, lead, guess);
        const ViewPoint p = mPatch.at(u, v);
        const Gradient2 f = evaluate(mPatch.f, u, v);
        const double du = mStretch.leadIsU ? 1 : -f.dv / f.du;
        const double dv = mStretch.leadIsU ? -f.du / f.dv : 1;
        const double moveX = p.xu * du + p.xv * dv, moveY = p.yu * du + p.yv * dv;
        auto [tx, ty] = foldDirection(p);
        double speed = moveX * tx + moveY * ty;
        if (mRule != CurveRule::Fold) {
            speed = std::hypot(moveX, moveY);
            if (speed > 0) {
                tx = moveX / speed;
                ty = moveY / speed;
            }
        }
        CurvePoint point{.x = p.x, .y = p.y, .z = p.z, .tx = tx, .ty = ty, .patch = mIndex};
        point.u = u;
        point.v = v;
        point.rule = mRule;
        return {lead, mStretch.leadIsU ? v : u, speed, point};
    }

    LedPoint between(const LedPoint& a, const LedPoint& b, double share) const {
        return at(a.lead + share * (b.lead - a.lead), a.follow + share * (b.follow - a.follow));
    }

    static double turn(const LedPoint& a, const LedPoint& b) {
        return a.point.tx * b.point.tx + a.point.ty * b.point.ty;
    }

    // Turns the direction of b, if it has no sign of its own, as that of a.
    void alignWith(const LedPoint& a, LedPoint& b) const {
        if (mRule != CurveRule::Fold || turn(a, b) >= 0) return;
        b.point.tx = -b.point.tx;
        b.point.ty = -b.point.ty;
        b.speed = -b.speed;
    }

    double distanceFromChord(const LedPoint& a, const LedPoint& b, const LedPoint& p) const {
        const double dx = b.point.x - a.point.x, dy = b.point.y - a.point.y;
        const double px = p.point.x - a.point.x, py = p.point.y - a.point.y;
        const double length = std::sqrt(dx * dx + dy * dy);
        if (length < 1e-12 * mSampling.size) return std::sqrt(px * px + py * py);
        return std::abs(dx * py - dy * px) / length;
    }

    // Where the image stops and turns back, between a and b.
    LedPoint cuspBetween(LedPoint a, LedPoint b) const {
        for (int step = 0; step < 60 && b.lead - a.lead > 1e-15; ++step) {
            LedPoint middle = between(a, b, 0.5);
            alignWith(a, middle);
            (middle.speed * a.speed > 0 ? a : b) = middle;
        }
        LedPoint cusp = b;
        cusp.speed = 0;
        cusp.point.corner = true;
        return cusp;
    }

    // Appends the points after a, up to b.
    void refine(const LedPoint& a, LedPoint b, int depth) {
        constexpr double kSmallTurn = 0.98, kBow = 1.3;
        constexpr int kMostHalvings = 40;
        alignWith(a, b);
        const double width = b.lead - a.lead;
        const bool isNarrow = depth > kMostHalvings || width < 1e-11;
        LedPoint middle = between(a, b, 0.5);
        alignWith(a, middle);
        const bool isSmooth = turn(a, b) > kSmallTurn && turn(a, middle) > kSmallTurn;
        if (!isNarrow && !isSmooth) return divide(a, middle, b, depth);
        const bool turnsBack = a.speed * b.speed < 0 || a.speed * middle.speed < 0;
        if (turnsBack && !isNarrow) {
            // The middle tells of two cusps between a and b, too.
            if (a.speed * middle.speed < 0 && middle.speed * b.speed < 0) {
                return divide(a, middle, b, depth);
            }
            const LedPoint cusp =
                a.speed * middle.speed < 0 ? cuspBetween(a, middle) : cuspBetween(middle, b);
            const bool isInside = cusp.lead > a.lead && cusp.lead < b.lead;
            if (isInside) {
                refine(a, cusp, depth + 1);
                refine(cusp, b, depth + 1);
                return;
            }
        }
        const double length = std::hypot(b.point.x - a.point.x, b.point.y - a.point.y);
        const auto isOnChord = [&](double share) {
            return distanceFromChord(a, b, between(a, b, share)) < mSampling.flatness;
        };
        // A wave may pass through the chord's middle.
        const bool isFlat = distanceFromChord(a, b, middle) < mSampling.flatness &&
                            bowBetween(a.point, b.point) < kBow * mSampling.flatness &&
                            length < 0.02 * mSampling.size && depth > 1 && isOnChord(0.25);
        if (!isNarrow && !isFlat) return divide(a, middle, b, depth);
        mPoints.push_back(b.point);
    }

    void divide(const LedPoint& a, const LedPoint& middle, const LedPoint& b, int depth) {
        refine(a, middle, depth + 1);
        refine(middle, b, depth + 1);
    }

    const ViewPatch& mPatch;
    int mIndex;
    const FoldStretch& mStretch;
    CurveRule mRule;
    const CurveSampling& mSampling;
    std::vector<CurvePoint> mPoints;
};

/// Puts stretches together to curves.
class StretchJoiner {
  public:
    StretchJoiner(std::vector<std::vector<CurvePoint>> stretches)
        : mStretches(std::move(stretches)), mPartner(2 * mStretches.size(), -1) {}

    void link(double reach) {
        for (std::size_t a = 0; a < mPartner.size(); ++a) {
            if (mPartner[a] >= 0) continue;
            double nearest = reach;
            int best = -1;
            for (std::size_t b = a + 1; b < mPartner.size(); ++b) {
                if (mPartner[b] >= 0) continue;
                const double distance =
                    std::max(std::abs(end(a).u - end(b).u), std::abs(end(a).v - end(b).v));
                if (distance < nearest) {
                    nearest = distance;
                    best = static_cast<int>(b);
                }
            }
            if (best < 0) continue;
            mPartner[a] = best;
            mPartner[static_cast<std::size_t>(best)] = static_cast<int>(a);
        }
    }

    std::vector<Curve> curves() {
        std::vector<bool> used(mStretches.size(), false);
        std::vector<Curve> result;
        // Those with free ends first; what is left is closed.
        for (const bool closed : {false, true}) {
            for (std::size_t e = 0; e < mPartner.size(); ++e) {
                if (used[e / 2] || (!closed && mPartner[e] >= 0)) continue;
                result.push_back(follow(static_cast<int>(e), used));
                result.back().closed = closed;
            }
        }
        return result;
    }

  private:
    // End 2 k is the start of stretch k, 2 k + 1 its end.
    const CurvePoint& end(std::size_t e) const {
        const auto& points = mStretches[e / 2];
        return e % 2 == 0 ? points.front() : points.back();
    }

    Curve follow(int e, std::vector<bool>& used) {
        Curve curve;
        while (e >= 0 && !used[static_cast<std::size_t>(e) / 2]) {
            const auto k = static_cast<std::size_t>(e) / 2;
            used[k] = true;
            auto& points = mStretches[k];
            if (e % 2 == 1) std::reverse(points.begin(), points.end());
            const std::size_t skip = curve.points.empty() ? 0 : 1;
            curve.points.insert(curve.points.end(),
                                points.begin() + static_cast<std::ptrdiff_t>(skip), points.end());
            e = mPartner[static_cast<std::size_t>(e ^ 1)];
        }
        return curve;
    }

    std::vector<std::vector<CurvePoint>> mStretches;
    std::vector<int> mPartner;
};

}  // namespace

std::vector<Curve> zeroCurves(const ViewPatch& patch, int index, CurveRule rule,
                              const CurveSampling& sampling) {
    const FoldCells cells = isolateFold(patch);
    std::vector<std::vector<CurvePoint>> stretches;
    for (const FoldStretch& stretch : cells.stretches) {
        stretches.push_back(StretchSampler(patch, index, stretch, rule, sampling).sample());
    }
    StretchJoiner joiner(std::move(stretches));
    joiner.link(1e-9);
    joiner.link(cells.looseEnds);
    std::vector<Curve> curves = joiner.curves();
    for (Curve& curve : curves) curve.object = patch.object;
    return curves;
}

std::vector<Curve> foldCurves(const ViewPatch& patch, int index, const CurveSampling& sampling) {
    return zeroCurves(patch, index, CurveRule::Fold, sampling);
}

}  // namespace bandvox
