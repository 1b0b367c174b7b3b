#include "outline/patches/face_cuts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bandvox {
namespace {

constexpr double kLeaf = 1e-8;    // of parameters: so near there is one cut, or none
constexpr double kExact = 1e-13;  // of the way between two points
// Of parts of the way between two points, all as long, through which loops may pass: a curve that
// crosses loops has a few of them, one that runs along a loop ever more.
constexpr std::size_t kMostParts = 1024;

/// Cuts one curve.
class CurveCut {
  public:
    CurveCut(const Curve& curve, const FaceRegions& faces, const PointBetween& between)
        : mCurve(curve), mFaces(faces), mBetween(between) {}

    void appendParts(std::vector<Curve>& parts) {
        const auto& points = mCurve.points;
        Piece piece{emptyPart()};
        piece.curve.points.push_back(points.front());
        bool isCut = false;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            search(points[i], points[i + 1], i > 0);
            double before = 0;
            for (const Stop& cut : mCuts) {
                isCut = true;
                piece.isAlong |= runsAlong(before, cut.share);
                if (cut.share > 0) piece.curve.points.push_back(cut.point);
                finish(std::exchange(piece, {emptyPart()}), parts);
                piece.curve.points.push_back(cut.point);
                before = cut.share;
            }
            piece.isAlong |= runsAlong(before, 1);
            piece.curve.points.push_back(points[i + 1]);
        }
        piece.curve.closed = mCurve.closed && !isCut;
        finish(std::move(piece), parts);
    }

  private:
    struct Stop {
        double share;
        CurvePoint point;
    };
    struct Span {
        Stop from, to;
    };
    struct Piece {
        Curve curve;
        bool isAlong = false;  // it runs along a loop
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

    // Whether loops may pass through a part of the way whose middle is m.
    bool mayCut(const Span& span, const CurvePoint& m) const {
        const CurvePoint &p = span.from.point, &q = span.to.point;
        return mayCut(mFaces, p.patch, {p.u, p.v}, {q.u, q.v}, {m.u, m.v}) ||
               (isMeeting() && mayCut(mFaces, p.other, {p.s, p.t}, {q.s, q.t}, {m.s, m.t}));
    }

    bool isLeaf(const Span& span) const {
        const CurvePoint &p = span.from.point, &q = span.to.point;
        const double length = std::hypot(p.u - q.u, p.v - q.v);
        return length < kLeaf && (!isMeeting() || std::hypot(p.s - q.s, p.t - q.t) < kLeaf);
    }

    // Finds the cuts between two points, and where the curve runs along loops.
    void search(const CurvePoint& a, const CurvePoint& b, bool hasBefore) {
        const bool wasAlong = !mRuns.empty() && mRuns.back().to.share == 1;
        mCuts.clear();
        mRuns.clear();
        std::vector<Span> spans{{{0, a}, {1, b}}};
        while (!spans.empty() && spans.size() <= kMostParts) {
            std::vector<Span> halves;
            for (const Span& span : spans) {
                const double half = 0.5 * (span.from.share + span.to.share);
                const Stop middle{half, mBetween(a, b, half)};
                if (!mayCut(span, middle.point)) continue;
                if (!isLeaf(span)) {
                    halves.push_back({span.from, middle});
                    halves.push_back({middle, span.to});
                } else if (keeps(span.from.point) != keeps(span.to.point)) {
                    mCuts.push_back(halved(a, b, span.from, span.to));
                }
            }
            spans = std::move(halves);
        }
        for (const Span& span : spans) {
            if (mRuns.empty() || mRuns.back().to.share != span.from.share) {
                mRuns.push_back(span);
            } else {
                mRuns.back().to = span.to;
            }
        }
        const bool isAlong = !mRuns.empty() && mRuns.front().from.share == 0;
        if (hasBefore && wasAlong != isAlong) cutUnlessKept({0, a});
        for (const Span& run : mRuns) {
            if (run.from.share > 0) cutUnlessKept(run.from);
            if (run.to.share < 1) cutUnlessKept(run.to);
        }
        std::sort(mCuts.begin(), mCuts.end(),
                  [](const Stop& x, const Stop& y) { return x.share < y.share; });
    }

    // What runs along a loop belongs to the face: beside it only what does goes on.
    void cutUnlessKept(const Stop& stop) {
        if (!keeps(stop.point)) mCuts.push_back(stop);
    }

    bool runsAlong(double from, double to) const {
        return std::any_of(mRuns.begin(), mRuns.end(), [&](const Span& run) {
            return run.from.share < to && run.to.share > from;
        });
    }

    Stop halved(const CurvePoint& a, const CurvePoint& b, Stop low, Stop high) const {
        const bool isKept = keeps(low.point);
        while (high.share - low.share > kExact) {
            const double half = 0.5 * (low.share + high.share);
            if (!(half > low.share && half < high.share)) break;
            const CurvePoint middle = mBetween(a, b, half);
            (keeps(middle) == isKept ? low : high) = {half, middle};
        }
        return isKept ? low : high;
    }

    // Keeps a part if its middle is.
    void finish(Piece piece, std::vector<Curve>& parts) const {
        const auto& points = piece.curve.points;
        const std::size_t count = points.size();
        if (count < 2) return;
        const CurvePoint &a = points[(count - 1) / 2], &b = points[(count - 1) / 2 + 1];
        if (piece.isAlong || keeps(mBetween(a, b, 0.5))) parts.push_back(std::move(piece.curve));
    }

    const Curve& mCurve;
    const FaceRegions& mFaces;
    const PointBetween& mBetween;
    // Of the last two points: cuts, and parts of the way that run along a loop, ascending.
    std::vector<Stop> mCuts;
    std::vector<Span> mRuns;
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
