#include "outline/patches/meeting_curves.h"

#include "outline/patches/meeting_branches.h"
#include "outline/patches/refine_point.h"

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

/// Makes curves of branches.
class MeetingTracer {
  public:
    MeetingTracer(std::span<const ViewPatch> seen, const CurveSampling& sampling)
        : mSeen(seen), mSampling(sampling) {}

    Curve trace(const MeetingPair& pair, const MeetingBranch& branch) const {
        Curve curve{.kind = OutlineKind::Intersection,
                    .closed = branch.closed,
                    .object = mSeen[static_cast<std::size_t>(pair.first)].object};
        for (const MeetingPlace& place : branch.places) {
            CurvePoint point{.patch = pair.first,
                             .u = place[0],
                             .v = place[1],
                             .other = pair.second,
                             .s = place[2],
                             .t = place[3],
                             .rule = CurveRule::Meeting};
            placeMeeting(mSeen, point);
            if (!curve.points.empty()) refine(curve.points.back(), point, 0, curve.points);
            curve.points.push_back(point);
        }
        if (curve.closed && !curve.points.empty()) curve.points.back() = curve.points.front();
        return curve;
    }

  private:
    // Appends what is needed between a and b.
    void refine(CurvePoint a, const CurvePoint& b, int depth,
                std::vector<CurvePoint>& points) const {
        const double dx = b.x - a.x, dy = b.y - a.y;
        const double length = std::hypot(dx, dy);
        // Directions of both points have the same sense: where they are opposite the curve, seen
        // nearly along itself, turns back.
        const bool isTurned = a.tx * b.tx + a.ty * b.ty < 0.7;
        if (depth > 12 || (length < mSampling.flatness && !isTurned)) return;
        const CurvePoint middle = pointBetween(mSeen, a, b, 0.5);
        const auto isOnChord = [&](const CurvePoint& p) {
            const double off = std::abs(dx * (p.y - a.y) - dy * (p.x - a.x));
            return off < mSampling.flatness * std::max(length, 1e-12 * mSampling.size);
        };
        // A wave may pass through the chord's middle.
        const bool isFlat = !isTurned && length < 0.02 * mSampling.size && isOnChord(middle) &&
                            bowBetween(a, b) < 1.3 * mSampling.flatness &&
                            isOnChord(pointBetween(mSeen, a, b, 0.25));
        if (isFlat) return;
        refine(a, middle, depth + 1, points);
        points.push_back(middle);
        refine(middle, b, depth + 1, points);
    }

    std::span<const ViewPatch> mSeen;
    const CurveSampling& mSampling;
};

}  // namespace

std::vector<Curve> meetingCurves(std::span<const ViewPatch> seen, std::span<const SharedSide> sides,
                                 const FaceRegions* faces, const CurveSampling& sampling,
                                 Progress& progress) {
    std::vector<Curve> curves;
    const MeetingTracer tracer(seen, sampling);
    for (const MeetingPair& pair : meetingBranches(seen, sides, sampling.size, progress, faces)) {
        for (const MeetingBranch& branch : pair.branches) {
            Curve curve = tracer.trace(pair, branch);
            if (curve.points.size() > 1) curves.push_back(std::move(curve));
        }
    }
    return curves;
}

}  // namespace bandvox
