#include "outline/patches/face_cuts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bandvox {
namespace {

constexpr double kLeaf = 1e-8;        // of parameters: so near there is one cut, or none
constexpr double kExact = 1e-13;      // of the way between two points
constexpr int kMostQuestions = 4000;  // for two points, of a curve that runs along a loop

/// Cuts one curve.
class CurveCut {
  public:
    CurveCut(const Curve& curve, const FaceRegions& faces, const PointBetween& between)
        : mCurve(curve), mFaces(faces), mBetween(between) {}

    void appendParts(std::vector<Curve>& parts) {
        const auto& points = mCurve.points;
        Curve part = emptyPart();
        part.points.push_back(points.front());
        bool isCut = false;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            mCuts.clear();
            mQuestions = 0;
            search(points[i], points[i + 1], {0, points[i]}, {1, points[i + 1]});
            for (const CurvePoint& cut : mCuts) {
                isCut = true;
                part.points.push_back(cut);
                finish(std::exchange(part, emptyPart()), parts);
                part.points.push_back(cut);
            }
            part.points.push_back(points[i + 1]);
        }
        part.closed = mCurve.closed && !isCut;
        finish(std::move(part), parts);
    }

  private:
    struct Stop {
        double share;
        CurvePoint point;
    };

    Curve emptyPart() const {
        return {.kind = mCurve.kind, .object = mCurve.object, .isDrawn = mCurve.isDrawn};
    }

    bool isMeeting() const { return mCurve.points.front().rule == CurveRule::Meeting; }

    bool keeps(const CurvePoint& p) const {
        return mFaces.keeps(p.patch, p.u, p.v) && (!isMeeting() || mFaces.keeps(p.other, p.s, p.t));
    }

    // Whether loops may cut between two places; the curve is no farther from their chord than
    // twice the middle is.
    static bool mayCut(const FaceRegions& faces, int patch, const std::array<double, 2>& p,
                       const std::array<double, 2>& q, const std::array<double, 2>& m) {
        ParameterBox box;
        box.expand(p);
        box.expand(q);
        for (std::size_t c = 0; c < 2; ++c) {
            const double bow = 2 * std::abs(m[c] - 0.5 * (p[c] + q[c])) + 1e-14;
            box.low[c] -= bow;
            box.high[c] += bow;
        }
        return faces.mayCut(patch, box);
    }

    void search(const CurvePoint& a, const CurvePoint& b, const Stop& from, const Stop& to) {
        if (++mQuestions > kMostQuestions) return;
        const double half = 0.5 * (from.share + to.share);
        const CurvePoint &p = from.point, &q = to.point, m = mBetween(a, b, half);
        bool may = mayCut(mFaces, p.patch, {p.u, p.v}, {q.u, q.v}, {m.u, m.v});
        if (isMeeting()) may |= mayCut(mFaces, p.other, {p.s, p.t}, {q.s, q.t}, {m.s, m.t});
        if (!may) return;
        double length = std::hypot(p.u - q.u, p.v - q.v);
        if (isMeeting()) length = std::max(length, std::hypot(p.s - q.s, p.t - q.t));
        if (length < kLeaf) {
            if (keeps(p) != keeps(q)) mCuts.push_back(halved(a, b, from, to));
            return;
        }
        search(a, b, from, {half, m});
        search(a, b, {half, m}, to);
    }

    CurvePoint halved(const CurvePoint& a, const CurvePoint& b, Stop low, Stop high) const {
        const bool isKept = keeps(low.point);
        while (high.share - low.share > kExact) {
            const double half = 0.5 * (low.share + high.share);
            if (!(half > low.share && half < high.share)) break;
            const CurvePoint middle = mBetween(a, b, half);
            (keeps(middle) == isKept ? low : high) = {half, middle};
        }
        return isKept ? low.point : high.point;
    }

    // Keeps a part if its middle is.
    void finish(Curve part, std::vector<Curve>& parts) const {
        const std::size_t count = part.points.size();
        if (count < 2) return;
        const CurvePoint &a = part.points[(count - 1) / 2], &b = part.points[(count - 1) / 2 + 1];
        if (keeps(mBetween(a, b, 0.5))) parts.push_back(std::move(part));
    }

    const Curve& mCurve;
    const FaceRegions& mFaces;
    const PointBetween& mBetween;
    std::vector<CurvePoint> mCuts;
    int mQuestions = 0;
};

}  // namespace

std::vector<Curve> cutToFaces(std::vector<Curve> curves, const FaceRegions* faces,
                              const PointBetween& between) {
    if (!faces) return curves;
    std::vector<Curve> result;
    for (Curve& curve : curves) {
        if (curve.points.size() < 2) continue;
        const CurvePoint& first = curve.points.front();
        const bool isTrimmed = faces->isTrimmed(first.patch) ||
                               (first.rule == CurveRule::Meeting && faces->isTrimmed(first.other));
        if (!isTrimmed) {
            result.push_back(std::move(curve));
        } else {
            CurveCut(curve, *faces, between).appendParts(result);
        }
    }
    return result;
}

}  // namespace bandvox
