#include "outline/fills/seen_regions.h"

#include "outline/drawing/draw_curves.h"
#include "outline/drawing/fit_cubics.h"
#include "outline/fills/face_labels.h"
#include "outline/fills/planar_map.h"
#include "outline/fills/weld_chains.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace bandvox {
namespace {

using Half = PlanarMap::HalfEdge;

std::size_t indexOf(std::int32_t i) {
    return static_cast<std::size_t>(i);
}

/// A border between two regions, from where three or more meet to where they do again, or around.
struct RegionBorder {
    std::vector<std::int32_t> halves;
    bool closed = false;
    std::vector<std::array<double, 2>> path;  // as OutlinePath has it
};

double extentOf(const Curve& curve) {
    double extent = 0;
    const CurvePoint& first = curve.points.front();
    for (const CurvePoint& p : curve.points) {
        extent = std::max(extent, std::hypot(p.x - first.x, p.y - first.y));
    }
    return extent;
}

/// Goes around what shows the same.
class RegionTracer {
  public:
    RegionTracer(const PlanarMap& map, const std::vector<FaceLabel>& labels,
                 std::span<const Curve> curves)
        : mMap(map),
          mLabels(labels),
          mCurves(curves),
          mDegrees(indexOf(map.vertices), 0),
          mBorderOf(map.halves.size(), -1) {
        for (const Half& half : mMap.halves) {
            if (isBorder(half)) ++mDegrees[indexOf(half.origin)];
        }
    }

    std::vector<OutlineFill> trace(double tolerance, Progress& progress) {
        findBorders();
        parallelFor(static_cast<std::int64_t>(mBorders.size()), [&](std::int64_t k) {
            progress.throwIfInterrupted();
            RegionBorder& border = mBorders[static_cast<std::size_t>(k)];
            const Curve curve = curveAlong(border);
            // What nobody can see would only be a path that stands still.
            if (extentOf(curve) > 1e-2 * tolerance) border.path = fitCubics(curve, tolerance);
        });
        return regions();
    }

  private:
    const Half& half(std::int32_t h) const { return mMap.halves[indexOf(h)]; }
    const Half& twinOf(const Half& h) const { return half(h.twin); }
    const FaceLabel& labelOf(const Half& h) const { return mLabels[indexOf(h.face)]; }
    bool isBorder(const Half& h) const { return !(labelOf(h) == labelOf(twinOf(h))); }
    bool isJunction(std::int32_t vertex) const { return mDegrees[indexOf(vertex)] != 2; }

    // The next half along the border of what shows the same.
    std::int32_t nextBorder(std::int32_t h) const {
        std::int32_t next = half(h).next;
        while (!isBorder(half(next))) next = half(half(next).twin).next;
        return next;
    }

    void findBorders() {
        // Those between junctions first; what is left goes around.
        for (const bool closed : {false, true}) {
            for (std::size_t h = 0; h < mMap.halves.size(); ++h) {
                const Half& first = mMap.halves[h];
                if (!isBorder(first) || mBorderOf[h] >= 0) continue;
                if (!closed && !isJunction(first.origin)) continue;
                RegionBorder border;
                border.closed = closed;
                auto at = static_cast<std::int32_t>(h);
                do {
                    border.halves.push_back(at);
                    mBorderOf[indexOf(at)] = static_cast<int>(mBorders.size());
                    mBorderOf[indexOf(half(at).twin)] = static_cast<int>(mBorders.size());
                    if (!closed && isJunction(twinOf(half(at)).origin)) break;
                    at = nextBorder(at);
                } while (at != border.halves.front());
                mBorders.push_back(std::move(border));
            }
        }
    }

    // A half's ends as points of the curve that it is a part of.
    CurvePoint pointAt(const Half& h, const std::array<double, 2>& place) const {
        const auto& points = mCurves[indexOf(h.chain)].points;
        const CurvePoint& a = points[indexOf(h.segment)];
        const CurvePoint& b = points[indexOf(h.segment) + 1];
        const auto isAt = [&](const CurvePoint& p) { return p.x == place[0] && p.y == place[1]; };
        if (isAt(a)) return a;
        if (isAt(b)) return b;
        // Where segments cross: both are nearly straight there.
        CurvePoint p = a;
        p.corner = false;
        p.x = place[0];
        p.y = place[1];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        p.tx = (b.x - a.x) / length;
        p.ty = (b.y - a.y) / length;
        return p;
    }

    static bool isSameDirection(const CurvePoint& a, const CurvePoint& b) {
        constexpr double kStraightOn = 0.9994;  // 2 degrees
        return std::abs(a.tx * b.tx + a.ty * b.ty) > kStraightOn;
    }

    Curve curveAlong(const RegionBorder& border) const {
        Curve curve;
        curve.closed = border.closed;
        auto& points = curve.points;
        for (const std::int32_t h : border.halves) {
            const Half& edge = half(h);
            CurvePoint from = pointAt(edge, edge.start);
            if (!points.empty() &&
                !(isSameDirection(points.back(), from) && goesOn(points, edge))) {
                points.back().corner = from.corner = true;
            }
            points.push_back(from);
            points.push_back(pointAt(edge, twinOf(edge).start));
        }
        if (border.closed) {
            const Half& first = half(border.halves.front());
            if (!(isSameDirection(points.back(), points.front()) && goesOn(points, first))) {
                points.back().corner = points.front().corner = true;
            }
        }
        return curve;
    }

    // Whether an edge goes on ahead from the last point, rather than back.
    bool goesOn(const std::vector<CurvePoint>& points, const Half& edge) const {
        const CurvePoint& a = points[points.size() - 2];
        const CurvePoint& b = points.back();
        const auto& end = twinOf(edge).start;
        const double along = (b.x - a.x) * (end[0] - b.x) + (b.y - a.y) * (end[1] - b.y);
        return along > 0;
    }

    void append(std::vector<std::array<double, 2>>& loop, std::int32_t h) const {
        const RegionBorder& border = mBorders[static_cast<std::size_t>(mBorderOf[indexOf(h)])];
        std::vector<std::array<double, 2>> path = border.path;
        const bool isForward =
            std::find(border.halves.begin(), border.halves.end(), h) != border.halves.end();
        if (!isForward) std::reverse(path.begin(), path.end());
        const std::size_t skip = loop.empty() || path.empty() ? 0 : 1;
        loop.insert(loop.end(), path.begin() + static_cast<std::ptrdiff_t>(skip), path.end());
    }

    std::vector<std::array<double, 2>> loopFrom(std::int32_t start,
                                                std::vector<bool>& isDone) const {
        std::int32_t first = start;
        std::vector<std::int32_t> around;
        do {
            around.push_back(first);
            isDone[indexOf(first)] = true;
            first = nextBorder(first);
        } while (first != start);
        const auto junction = std::find_if(around.begin(), around.end(), [&](std::int32_t h) {
            return isJunction(half(h).origin);
        });
        if (junction != around.end()) std::rotate(around.begin(), junction, around.end());
        std::vector<std::array<double, 2>> loop;
        int border = -1;
        for (const std::int32_t h : around) {
            const bool begins = isJunction(half(h).origin) || border < 0;
            border = mBorderOf[indexOf(h)];
            if (begins) append(loop, h);
        }
        if (!loop.empty()) loop.back() = loop.front();
        return loop;
    }

    // The first face of those that show the same around a face.
    std::vector<std::int32_t> connected() const {
        std::vector<std::int32_t> root(indexOf(mMap.faces));
        std::iota(root.begin(), root.end(), 0);
        const auto find = [&](std::int32_t f) {
            while (root[indexOf(f)] != f) {
                root[indexOf(f)] = root[indexOf(root[indexOf(f)])];
                f = root[indexOf(f)];
            }
            return f;
        };
        for (const Half& h : mMap.halves) {
            if (isBorder(h)) continue;
            const std::int32_t a = find(h.face), b = find(twinOf(h).face);
            root[indexOf(std::max(a, b))] = std::min(a, b);
        }
        for (std::int32_t f = 0; f < mMap.faces; ++f) root[indexOf(f)] = find(f);
        return root;
    }

    std::vector<OutlineFill> regions() const {
        const std::vector<std::int32_t> root = connected();
        std::vector<OutlineFill> fills(root.size());
        std::vector<bool> isDone(mMap.halves.size(), false);
        for (std::size_t h = 0; h < mMap.halves.size(); ++h) {
            const Half& start = mMap.halves[h];
            const FaceLabel& label = labelOf(start);
            if (isDone[h] || !isBorder(start) || label.object < 0) continue;
            OutlineFill& fill = fills[indexOf(root[indexOf(start.face)])];
            fill.object = label.object;
            fill.tone = label.tone;
            auto loop = loopFrom(static_cast<std::int32_t>(h), isDone);
            if (loop.size() > 4) fill.loops.push_back(std::move(loop));
        }
        std::erase_if(fills, [](const OutlineFill& fill) { return fill.loops.empty(); });
        std::stable_sort(fills.begin(), fills.end(), [](const auto& a, const auto& b) {
            return std::pair(a.object, a.tone) < std::pair(b.object, b.tone);
        });
        return fills;
    }

    const PlanarMap& mMap;
    const std::vector<FaceLabel>& mLabels;
    std::span<const Curve> mCurves;
    std::vector<int> mDegrees;   // of vertices: borders that end there
    std::vector<int> mBorderOf;  // of halves
    std::vector<RegionBorder> mBorders;
};

PlanarChain chainOf(const Curve& curve) {
    PlanarChain chain;
    chain.reserve(curve.points.size());
    for (const CurvePoint& p : curve.points) chain.push_back({p.x, p.y});
    return chain;
}

}  // namespace

std::vector<OutlineFill> seenRegions(std::span<const VisiblePiece> pieces, const CurveScene& scene,
                                     const OutlineOptions& options, Progress& progress) {
    std::vector<Curve> curves = weldedCurves(pieces, scene, samplingFor(options));
    for (Curve& curve : curves) {
        if (curve.closed) curve.points.push_back(curve.points.front());
    }
    std::vector<PlanarChain> chains(curves.size());
    std::transform(curves.begin(), curves.end(), chains.begin(), chainOf);
    progress.throwIfInterrupted();
    const PlanarMap map = planarMap(chains);
    std::vector<double> tones;
    if (options.fill == OutlineFillKind::Toon) tones = options.tones;
    const std::vector<FaceLabel> labels = faceLabels(map, scene, tones, progress);
    return RegionTracer(map, labels, curves).trace(options.tolerance, progress);
}

}  // namespace bandvox
