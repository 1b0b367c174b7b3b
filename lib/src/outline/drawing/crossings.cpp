#include "outline/drawing/crossings.h"

#include "outline/drawing/segment_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bandvox {
namespace {

// Parts of the page's size. Where a surface passes through a fold the two curves are in the same
// place, and rounding must not tell which one is in front: a place too many does no harm.
constexpr double kSameDepth = 1e-5;
// Chords of curves that lead away from the eye are far from them in depth, not on the page.
constexpr double kTouchingDepth = 0.02;

bool occludes(const Curve& curve) {
    return curve.kind == OutlineKind::Contour || curve.kind == OutlineKind::Boundary;
}

// Where such a curve meets one of a surface that it lies on, the other one passes through a
// surface.
bool passesThrough(const Curve& curve) {
    return curve.kind == OutlineKind::Intersection;
}

// A curve that a fold of its surface may pass.
bool liesOnSurface(const Curve& curve) {
    return curve.kind == OutlineKind::Intersection || curve.kind == OutlineKind::Isophote;
}

class CrossingSearch {
  public:
    CrossingSearch(std::span<const Curve> curves, CurveReader& reader,
                   const CurveSampling& sampling)
        : mCurves(curves),
          mReader(reader),
          mSize(sampling.size),
          mFlatness(sampling.flatness),
          mGrid(curves, sampling.size / 200),
          mPlaces(curves.size()) {}

    std::vector<CurvePlaces> search() {
        for (const auto& [key, segments] : mGrid.cells()) {
            for (std::size_t a = 0; a < segments.size(); ++a) {
                for (std::size_t b = a + 1; b < segments.size(); ++b) {
                    cross(segments[a], segments[b]);
                }
            }
        }
        for (std::size_t c = 0; c < mCurves.size(); ++c) {
            if (liesOnSurface(mCurves[c])) passFolds(c);
            if (mCurves[c].closed || mCurves[c].points.empty()) continue;
            touch(c, mCurves[c].points.front());
            touch(c, mCurves[c].points.back());
        }
        for (CurvePlaces& places : mPlaces) {
            std::sort(places.begin(), places.end());
            places.erase(std::unique(places.begin(), places.end()), places.end());
        }
        return std::move(mPlaces);
    }

  private:
    bool areNeighbours(const CurveSegment& a, const CurveSegment& b) const {
        if (a.curve != b.curve) return false;
        const std::uint32_t apart = a.index > b.index ? a.index - b.index : b.index - a.index;
        const auto last = static_cast<std::uint32_t>(mCurves[a.curve].points.size()) - 2;
        return apart <= 1 || (mCurves[a.curve].closed && apart >= last);
    }

    void cross(const CurveSegment& a, const CurveSegment& b) {
        const Curve& first = mCurves[a.curve];
        const Curve& second = mCurves[b.curve];
        const bool mayPassThrough = passesThrough(first) || passesThrough(second);
        if (!occludes(first) && !occludes(second) && !mayPassThrough) return;
        if (areNeighbours(a, b)) return;
        const CurvePoint &p = mGrid.start(a), &q = mGrid.end(a);
        const CurvePoint &r = mGrid.start(b), &s = mGrid.end(b);
        const double ax = q.x - p.x, ay = q.y - p.y, bx = s.x - r.x, by = s.y - r.y;
        const double area = ax * by - ay * bx;
        if (area == 0) return;
        const double alongA = ((r.x - p.x) * by - (r.y - p.y) * bx) / area;
        const double alongB = ((r.x - p.x) * ay - (r.y - p.y) * ax) / area;
        if (alongA < 0 || alongA > 1 || alongB < 0 || alongB > 1) return;
        Spot onA{.segment = a, .share = alongA, .at = {}},
            onB{.segment = b, .share = alongB, .at = {}};
        if (!settle(onA, onB) || areNeighbours(onA.segment, onB.segment)) return;
        const double near = kSameDepth * mSize;
        if (mayPassThrough && std::abs(onA.at.z - onB.at.z) < near) {
            mPlaces[a.curve].push_back(onA.place());
            mPlaces[b.curve].push_back(onB.place());
            return;
        }
        if (occludes(second) && onB.at.z < onA.at.z + near) mPlaces[a.curve].push_back(onA.place());
        if (occludes(first) && onA.at.z < onB.at.z + near) mPlaces[b.curve].push_back(onB.place());
    }

    // A segment's ends.
    struct Ends {
        const CurvePoint *from, *to;
    };
    Ends endsOf(const CurveSegment& segment) const {
        return {&mGrid.start(segment), &mGrid.end(segment)};
    }

    // A place of a curve, and how fast it moves there with the share of the segment.
    struct Spot {
        CurveSegment segment;
        double share;
        CurvePoint at;
        double dx = 0, dy = 0;

        double place() const { return segment.index + share; }
    };

    void read(Spot& spot) const {
        const auto [from, to] = endsOf(spot.segment);
        spot.at = mReader.between(*from, *to, spot.share);
        spot.dx = to->x - from->x;
        spot.dy = to->y - from->y;
    }

    // Along the curve; from one segment no farther than into the next.
    void move(Spot& spot, double by) const {
        const Spot before = spot;
        moveShare(spot, before.share + by);
        read(spot);
        const double moved = spot.share - before.share;
        constexpr double kLeast = 1e-9;
        if (spot.segment.index != before.segment.index || std::abs(moved) < kLeast) return;
        // Near a cusp a curve is much slower at one end of a segment than at the other.
        spot.dx = (spot.at.x - before.at.x) / moved;
        spot.dy = (spot.at.y - before.at.y) / moved;
    }

    void moveShare(Spot& spot, double share) const {
        const auto count = static_cast<std::uint32_t>(mCurves[spot.segment.curve].points.size());
        const bool isClosed = mCurves[spot.segment.curve].closed;
        std::uint32_t& index = spot.segment.index;
        spot.share = std::clamp(share, 0.0, 1.0);
        if (share > 1 && (isClosed || index + 2 < count)) {
            index = index + 2 < count ? index + 1 : 0;
            spot.share = std::min(share - 1, 1.0);
        } else if (share < 0 && (isClosed || index > 0)) {
            index = index > 0 ? index - 1 : count - 2;
            spot.share = std::max(share + 1, 0.0);
        }
    }

    // From where chords cross to where the curves do, which may be in a segment beside; false if
    // they do not cross there.
    bool settle(Spot& a, Spot& b) const {
        double away = 0;
        read(a);
        read(b);
        for (int round = 0; round < 16; ++round) {
            const double gx = b.at.x - a.at.x, gy = b.at.y - a.at.y;
            away = std::hypot(gx, gy);
            if (away < 1e-3 * mFlatness) return true;
            const double area = a.dx * b.dy - a.dy * b.dx;
            if (area == 0) break;
            const double byA = (gx * b.dy - gy * b.dx) / area;
            const double byB = (gx * a.dy - gy * a.dx) / area;
            move(a, byA);
            move(b, byB);
        }
        return away < 2 * mFlatness;
    }

    // The share of a segment where the curve is nearest to a place, from that of the chord.
    double shareNear(const Ends& ends, const CurvePoint& p, double share) const {
        const double dx = ends.to->x - ends.from->x, dy = ends.to->y - ends.from->y;
        const double square = dx * dx + dy * dy;
        for (int round = 0; round < 12; ++round) {
            const CurvePoint q = mReader.between(*ends.from, *ends.to, share);
            const double behind = ((p.x - q.x) * dx + (p.y - q.y) * dy) / square;
            share = std::clamp(share + behind, 0.0, 1.0);
            if (behind * behind * square < 1e-6 * mFlatness * mFlatness) break;
        }
        return share;
    }

    // Where a curve goes over a fold of one of its surfaces, by halving.
    void passFolds(std::size_t curve) {
        const auto& points = mCurves[curve].points;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const CurvePoint &a = points[i], &b = points[i + 1];
            if (a.patch != b.patch || a.other != b.other) continue;
            for (const bool isOther : {false, true}) {
                if ((mReader.foldAt(a, isOther) >= 0) == (mReader.foldAt(b, isOther) >= 0))
                    continue;
                double low = 0, high = 1;
                CurvePoint middle = a;
                while (high - low > 1e-6) {
                    const double share = 0.5 * (low + high);
                    middle = mReader.between(a, b, share);
                    const bool isLow =
                        (mReader.foldAt(middle, isOther) >= 0) == (mReader.foldAt(a, isOther) >= 0);
                    (isLow ? low : high) = share;
                }
                mPlaces[curve].push_back(static_cast<double>(i) + low);
                touch(curve, middle);
            }
        }
    }

    // Curves that pass through the end of another one, in space.
    void touch(std::size_t curve, const CurvePoint& p) {
        const double reach = 2 * mFlatness;
        mGrid.visitNear(p.x, p.y, [&](const CurveSegment& segment) {
            if (segment.curve == curve) return;
            const CurvePoint &a = mGrid.start(segment), &b = mGrid.end(segment);
            const double dx = b.x - a.x, dy = b.y - a.y;
            const double square = dx * dx + dy * dy;
            if (!(square > 0)) return;
            const double share =
                std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0);
            const double away = std::hypot(a.x + share * dx - p.x, a.y + share * dy - p.y);
            const double below = a.z + share * (b.z - a.z) - p.z;
            if (away > reach || std::abs(below) > kTouchingDepth * mSize) return;
            mPlaces[segment.curve].push_back(segment.index + shareNear({&a, &b}, p, share));
        });
    }

    std::span<const Curve> mCurves;
    CurveReader& mReader;
    double mSize, mFlatness;
    SegmentGrid mGrid;
    std::vector<CurvePlaces> mPlaces;
};

}  // namespace

std::vector<CurvePlaces> crossings(std::span<const Curve> curves, CurveReader& reader,
                                   const CurveSampling& sampling) {
    return CrossingSearch(curves, reader, sampling).search();
}

}  // namespace bandvox
