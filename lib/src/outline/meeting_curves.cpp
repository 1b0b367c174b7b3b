#include "outline/meeting_curves.h"

#include "outline/net_meetings.h"
#include "outline/refine_point.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

constexpr int kFewestSteps = 4;
constexpr int kMostSteps = 32;
constexpr double kMostTriangles = 4e5;

// Steps with which chords of a patch are closer to it than `tolerance`, by second differences.
int stepsFor(const ViewPatch& patch, double tolerance) {
    double bend = 0;
    for (const Bernstein2* axis : {&patch.x, &patch.y, &patch.z}) {
        for (const Bernstein2& second :
             {derivativeU(derivativeU(*axis)), derivativeV(derivativeV(*axis))}) {
            bend = std::max(bend, second.largestMagnitude() / patch.w.smallest());
        }
    }
    return static_cast<int>(
        std::clamp(std::ceil(std::sqrt(bend / (8 * tolerance))), 1.0, double(kMostSteps)));
}

std::vector<PatchNet> netsOf(std::span<const ViewPatch> seen, double size) {
    int steps = kFewestSteps;
    for (const ViewPatch& patch : seen) steps = std::max(steps, stepsFor(patch, 1e-3 * size));
    const double most = std::sqrt(kMostTriangles / 2 / static_cast<double>(seen.size()));
    steps = std::clamp(steps, 1, std::max(2, static_cast<int>(most)));
    std::vector<PatchNet> nets(seen.size());
    parallelFor(static_cast<std::int64_t>(seen.size()), [&](std::int64_t k) {
        const auto index = static_cast<std::size_t>(k);
        nets[index].steps = steps;
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; j <= steps; ++j) {
                const ViewPoint p = seen[index].at(double(i) / steps, double(j) / steps);
                nets[index].points.push_back({p.x, p.y, p.z});
            }
        }
    });
    return nets;
}

/// Makes exact curves of chains of places.
class MeetingTracer {
  public:
    MeetingTracer(std::span<const ViewPatch> seen, const CurveSampling& sampling)
        : mSeen(seen), mSampling(sampling) {}

    Curve trace(const NetMeetings& chain) const {
        Curve curve{.kind = OutlineKind::Intersection,
                    .object = mSeen[static_cast<std::size_t>(chain.first)].object};
        for (const NetMeeting& place : chain.places) {
            CurvePoint point{.patch = chain.first,
                             .u = place.u,
                             .v = place.v,
                             .other = chain.second,
                             .s = place.s,
                             .t = place.t};
            if (!meet(mSeen, point) || isSelf(point)) continue;
            if (!curve.points.empty()) refine(curve.points.back(), point, 0, curve.points);
            curve.points.push_back(point);
        }
        if (chain.closed && curve.points.size() > 2) {
            curve.closed = true;
            const CurvePoint first = curve.points.front();
            refine(curve.points.back(), first, 0, curve.points);
            curve.points.push_back(first);
        }
        return curve;
    }

  private:
    // A place of a patch meets itself everywhere.
    static bool isSelf(const CurvePoint& p) {
        return p.patch == p.other && std::max(std::abs(p.u - p.s), std::abs(p.v - p.t)) < 1e-3;
    }

    // Appends what is needed between a and b.
    void refine(CurvePoint a, const CurvePoint& b, int depth,
                std::vector<CurvePoint>& points) const {
        const double dx = b.x - a.x, dy = b.y - a.y;
        const double length = std::hypot(dx, dy);
        if (depth > 12 || length < mSampling.flatness) return;
        const CurvePoint middle = pointBetween(mSeen, a, b, 0.5);
        const double off = std::abs(dx * (middle.y - a.y) - dy * (middle.x - a.x)) / length;
        if (off < mSampling.flatness && length < 0.02 * mSampling.size) return;
        refine(a, middle, depth + 1, points);
        points.push_back(middle);
        refine(middle, b, depth + 1, points);
    }

    std::span<const ViewPatch> mSeen;
    const CurveSampling& mSampling;
};

}  // namespace

std::vector<Curve> meetingCurves(std::span<const ViewPatch> seen, const CurveSampling& sampling,
                                 Progress& progress) {
    std::vector<Curve> curves;
    const MeetingTracer tracer(seen, sampling);
    for (const NetMeetings& chain : netMeetings(netsOf(seen, sampling.size))) {
        progress.throwIfInterrupted();
        Curve curve = tracer.trace(chain);
        if (curve.points.size() > 1) curves.push_back(std::move(curve));
    }
    return curves;
}

}  // namespace bandvox
