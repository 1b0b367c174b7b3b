#include "outline/fills/weld_chains.h"

#include "outline/drawing/segment_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

namespace bandvox {
namespace {

/// An end of a curve, and the place where it ends.
struct LooseEnd {
    std::size_t curve;
    bool atEnd;
    std::size_t place;
};

/// A place where lines end.
struct WeldPlace {
    double x, y;
    int ends = 0;
    bool isOnLine = false;
};

/// A point that a curve is to get, after the point of number `segment`.
struct NewPoint {
    std::size_t segment;
    double share;
    CurvePoint point;
};

/// The nearest point of a curve.
struct NearPoint {
    CurveSegment segment{};
    double share = 0, away = HUGE_VAL;
};

class ChainWelder {
  public:
    ChainWelder(std::vector<Curve> curves, const CurveScene& scene, const CurveSampling& sampling)
        : mCurves(std::move(curves)),
          mReader(scene.reader()),
          mReach(2 * sampling.flatness),
          mBridge(std::max(mReach, 5e-4 * sampling.size)),
          mGrid(mCurves, std::max(sampling.size / 200, mBridge)),
          mNew(mCurves.size()) {}

    std::vector<Curve> weld() {
        findPlaces();
        for (std::size_t k = 0; k < mPlaces.size(); ++k) passPlace(k);
        for (const LooseEnd& end : mEnds) {
            const WeldPlace& place = mPlaces[end.place];
            if (place.ends == 1 && !place.isOnLine) bridge(end);
        }
        for (const LooseEnd& end : mEnds) moveEnd(end);
        for (std::size_t c = 0; c < mCurves.size(); ++c) addPoints(mCurves[c], mNew[c]);
        for (const auto& [end, point] : mBridges) extend(end, point);
        return std::move(mCurves);
    }

  private:
    const CurvePoint& pointOf(const LooseEnd& end) const {
        const auto& points = mCurves[end.curve].points;
        return end.atEnd ? points.back() : points.front();
    }

    void findPlaces() {
        std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> cells;
        const auto index = [&](double x) {
            return static_cast<std::int64_t>(std::floor(x / mReach));
        };
        for (std::size_t c = 0; c < mCurves.size(); ++c) {
            if (mCurves[c].closed) continue;
            for (const bool atEnd : {false, true}) {
                LooseEnd end{c, atEnd, mPlaces.size()};
                const CurvePoint& p = pointOf(end);
                const std::int64_t i = index(p.x), j = index(p.y);
                double nearest = mReach;
                for (int near = 0; near < 9; ++near) {
                    const auto found = cells.find({i + near % 3 - 1, j + near / 3 - 1});
                    if (found == cells.end()) continue;
                    for (const std::size_t k : found->second) {
                        const double away = std::hypot(mPlaces[k].x - p.x, mPlaces[k].y - p.y);
                        if (away > nearest) continue;
                        nearest = away;
                        end.place = k;
                    }
                }
                if (end.place == mPlaces.size()) {
                    cells[{i, j}].push_back(end.place);
                    mPlaces.push_back({p.x, p.y});
                }
                ++mPlaces[end.place].ends;
                mEnds.push_back(end);
                mEndsOf[c].push_back(end);
            }
        }
    }

    NearPoint nearPoint(const CurveSegment& segment, const WeldPlace& place) const {
        const CurvePoint &a = mGrid.start(segment), &b = mGrid.end(segment);
        const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
        if (!(square > 0)) return {};
        const double along = (place.x - a.x) * dx + (place.y - a.y) * dy;
        const double share = std::clamp(along / square, 0.0, 1.0);
        return {segment, share, std::hypot(a.x + share * dx - place.x, a.y + share * dy - place.y)};
    }

    // A curve is near to a place where it ends itself.
    bool endsNear(const NearPoint& near, std::size_t place) const {
        const auto found = mEndsOf.find(near.segment.curve);
        if (found == mEndsOf.end()) return false;
        const auto& points = mCurves[near.segment.curve].points;
        for (const LooseEnd& end : found->second) {
            if (end.place != place) continue;
            double length = 0;
            const std::size_t last = points.size() - 1;
            const std::size_t count =
                end.atEnd ? last - near.segment.index - 1 : near.segment.index;
            for (std::size_t k = 0; k < count && length < 4 * mBridge; ++k) {
                const std::size_t i = end.atEnd ? last - k : k, j = end.atEnd ? i - 1 : i + 1;
                length += std::hypot(points[i].x - points[j].x, points[i].y - points[j].y);
            }
            if (length < 4 * mBridge) return true;
        }
        return false;
    }

    // The curves that pass a place get a point there.
    void passPlace(std::size_t number) {
        WeldPlace& place = mPlaces[number];
        std::map<std::uint32_t, NearPoint> nearest;
        mGrid.visitNear(place.x, place.y, [&](const CurveSegment& segment) {
            const NearPoint near = nearPoint(segment, place);
            if (near.away > mReach || endsNear(near, number)) return;
            NearPoint& best = nearest[segment.curve];
            if (near.away < best.away) best = near;
        });
        for (const auto& [curve, near] : nearest) {
            place.isOnLine = true;
            addPoint(near, place.x, place.y);
        }
    }

    void addPoint(const NearPoint& near, double x, double y) {
        CurvePoint point =
            mReader->between(mGrid.start(near.segment), mGrid.end(near.segment), near.share);
        point.x = x;
        point.y = y;
        mNew[near.segment.curve].push_back({near.segment.index, near.share, point});
    }

    void bridge(const LooseEnd& end) {
        const WeldPlace& place = mPlaces[end.place];
        NearPoint best;
        mGrid.visitNear(place.x, place.y, [&](const CurveSegment& segment) {
            const NearPoint near = nearPoint(segment, place);
            if (near.away < best.away && near.away < mBridge && !endsNear(near, end.place)) {
                best = near;
            }
        });
        if (best.away == HUGE_VAL) return;
        const CurvePoint &a = mGrid.start(best.segment), &b = mGrid.end(best.segment);
        CurvePoint target = best.share < 0.5 ? a : b;
        target.x = a.x + best.share * (b.x - a.x);
        target.y = a.y + best.share * (b.y - a.y);
        addPoint(best, target.x, target.y);
        mBridges.emplace_back(end, target);
    }

    void moveEnd(const LooseEnd& end) {
        auto& points = mCurves[end.curve].points;
        CurvePoint& point = end.atEnd ? points.back() : points.front();
        point.x = mPlaces[end.place].x;
        point.y = mPlaces[end.place].y;
    }

    static void addPoints(Curve& curve, std::vector<NewPoint>& points) {
        std::sort(points.begin(), points.end(), [](const NewPoint& a, const NewPoint& b) {
            return std::pair(a.segment, a.share) < std::pair(b.segment, b.share);
        });
        std::vector<CurvePoint> all;
        all.reserve(curve.points.size() + points.size());
        std::size_t next = 0;
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            all.push_back(curve.points[i]);
            for (; next < points.size() && points[next].segment == i; ++next) {
                all.push_back(points[next].point);
            }
        }
        curve.points = std::move(all);
    }

    void extend(const LooseEnd& end, const CurvePoint& target) {
        auto& points = mCurves[end.curve].points;
        CurvePoint& last = end.atEnd ? points.back() : points.front();
        last.corner = true;
        CurvePoint from = last, to = target;
        const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
        if (!(length > 0)) return;
        from.tx = to.tx = dx / length;
        from.ty = to.ty = dy / length;
        to.corner = false;
        if (end.atEnd) {
            points.insert(points.end(), {from, to});
        } else {
            points.insert(points.begin(), {to, from});
        }
    }

    std::vector<Curve> mCurves;
    std::unique_ptr<CurveReader> mReader;
    double mReach, mBridge;
    SegmentGrid mGrid;
    std::vector<std::vector<NewPoint>> mNew;
    std::vector<WeldPlace> mPlaces;
    std::vector<LooseEnd> mEnds;
    std::map<std::size_t, std::vector<LooseEnd>> mEndsOf;
    std::vector<std::pair<LooseEnd, CurvePoint>> mBridges;
};

}  // namespace

std::vector<Curve> weldedCurves(std::span<const VisiblePiece> pieces, const CurveScene& scene,
                                const CurveSampling& sampling) {
    std::vector<Curve> seen;
    for (const VisiblePiece& piece : pieces) {
        // What is on both sides of a suggestive contour is the same.
        if (piece.curve.kind == OutlineKind::Suggestive) continue;
        if (piece.hidden == 0 && piece.curve.points.size() > 1) seen.push_back(piece.curve);
    }
    return ChainWelder(std::move(seen), scene, sampling).weld();
}

}  // namespace bandvox
