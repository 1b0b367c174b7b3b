#include "outline/drawing/slivers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace bandvox {
namespace {

using CurvePoints = std::vector<CurvePoint>;

double pageDistance(const CurvePoint& a, const CurvePoint& b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

double fromChord(const CurvePoint& p, const CurvePoint& a, const CurvePoint& b) {
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
    const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
    return std::hypot(a.x + share * dx - p.x, a.y + share * dy - p.y);
}

// Whether the places of one part of a curve are all within a distance of another part.
bool isWithin(std::span<const CurvePoint> part, std::span<const CurvePoint> other, double reach) {
    return std::all_of(part.begin(), part.end(), [&](const CurvePoint& p) {
        for (std::size_t i = 1; i < other.size(); ++i) {
            if (fromChord(p, other[i - 1], other[i]) <= reach) return true;
        }
        return false;
    });
}

CurvePoints rangeOf(const CurvePoints& points, std::size_t begin, std::size_t end) {
    return {points.begin() + static_cast<std::ptrdiff_t>(begin),
            points.begin() + static_cast<std::ptrdiff_t>(end)};
}

std::size_t farthestFrom(const CurvePoints& points, std::size_t from) {
    std::size_t farthest = from;
    double most = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double away = pageDistance(points[i], points[from]);
        if (away <= most) continue;
        most = away;
        farthest = i;
    }
    return farthest;
}

// Whether a closed curve goes there and back nearly the same way.
bool isSliver(const Curve& curve, double width) {
    const CurvePoints& points = curve.points;
    const std::size_t a = farthestFrom(points, 0), b = farthestFrom(points, a);
    const std::size_t begin = std::min(a, b), end = std::max(a, b);
    const CurvePoints there = rangeOf(points, begin, end + 1);
    CurvePoints back = rangeOf(points, end, points.size());
    back.insert(back.end(), points.begin() + 1,
                points.begin() + static_cast<std::ptrdiff_t>(begin) + 1);
    return isWithin(there, back, width) && isWithin(back, there, width);
}

/// A curve from one corner to the next.
struct CornerPart {
    CurvePoints points;
    double length = 0;
    bool isKept = false;  // it goes another way than the parts beside it
};

CornerPart partOf(CurvePoints points) {
    CornerPart part{std::move(points)};
    for (std::size_t i = 1; i < part.points.size(); ++i) {
        part.length += pageDistance(part.points[i - 1], part.points[i]);
    }
    return part;
}

std::vector<CornerPart> partsOf(const Curve& curve) {
    CurvePoints points = curve.points;
    const auto isCorner = [](const CurvePoint& p) { return p.corner; };
    if (curve.closed) {
        points.pop_back();
        std::rotate(points.begin(), std::find_if(points.begin(), points.end(), isCorner),
                    points.end());
        points.push_back(points.front());
    }
    std::vector<CornerPart> parts;
    for (std::size_t begin = 0, i = 1; i < points.size(); ++i) {
        if (!points[i].corner && i + 1 < points.size()) continue;
        parts.push_back(partOf(rangeOf(points, begin, i + 1)));
        begin = i;
    }
    return parts;
}

// The first of a part's points, up to a length.
CurvePoints beginningOf(const CurvePoints& points, double length) {
    CurvePoints some{points[0]};
    for (std::size_t i = 1; i < points.size() && length > 0; ++i) {
        length -= pageDistance(points[i - 1], points[i]);
        some.push_back(points[i]);
    }
    return some;
}

bool goesBack(const CornerPart& before, const CornerPart& part, const CornerPart& after,
              double width) {
    if (part.length > std::min(before.length, after.length) + width) return false;
    const double length = 1.5 * part.length + 2 * width;
    const CurvePoints end = beginningOf({before.points.rbegin(), before.points.rend()}, length);
    return isWithin(part.points, end, width) &&
           isWithin(part.points, beginningOf(after.points, length), width);
}

// One part and what is left of another one beyond the corner at which it ends.
CornerPart joinBeyond(CornerPart before, double back, const CornerPart& after) {
    before.points.back().corner = false;
    double length = 0;
    for (std::size_t i = 1; i < after.points.size(); ++i) {
        length += pageDistance(after.points[i - 1], after.points[i]);
        if (length > back || i + 1 == after.points.size()) before.points.push_back(after.points[i]);
    }
    return partOf(std::move(before.points));
}

// Takes the shortest part that goes back out of the curve; false if there is none.
bool dropShortest(std::vector<CornerPart>& parts, bool isClosed, double width) {
    const std::size_t count = parts.size();
    if (count < 3) return false;
    std::size_t shortest = count;
    for (std::size_t i = 0; i < count; ++i) {
        if (parts[i].isKept || (!isClosed && (i == 0 || i + 1 == count))) continue;
        if (shortest == count || parts[i].length < parts[shortest].length) shortest = i;
    }
    if (shortest == count) return false;
    // So that its neighbours lie beside it.
    if (isClosed) {
        const std::size_t first = (shortest + count - 1) % count;
        std::rotate(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(first), parts.end());
        shortest = 1;
    }
    const auto at = parts.begin() + static_cast<std::ptrdiff_t>(shortest);
    if (!goesBack(at[-1], at[0], at[1], width)) {
        at->isKept = true;
        return true;
    }
    at[-1] = joinBeyond(std::move(at[-1]), at->length, at[1]);
    parts.erase(at, at + 2);
    for (CornerPart& part : parts) part.isKept = false;
    return true;
}

void straighten(Curve& curve, double width) {
    const auto corners = std::count_if(curve.points.begin(), curve.points.end(),
                                       [](const CurvePoint& p) { return p.corner; });
    if (corners < 2) return;
    std::vector<CornerPart> parts = partsOf(curve);
    const std::size_t before = parts.size();
    while (dropShortest(parts, curve.closed, width)) {
    }
    if (parts.size() == before) return;
    curve.points = {parts[0].points[0]};
    for (const CornerPart& part : parts) {
        curve.points.insert(curve.points.end(), part.points.begin() + 1, part.points.end());
    }
    if (curve.closed) curve.points.front().corner = curve.points.back().corner;
}

}  // namespace

std::vector<Curve> withoutSlivers(std::vector<Curve> curves, double width) {
    std::erase_if(curves,
                  [&](const Curve& curve) { return curve.closed && isSliver(curve, width); });
    for (Curve& curve : curves) straighten(curve, width);
    return curves;
}

}  // namespace bandvox
