#include "outline/drawing/join_curves.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_map>

namespace bandvox {
namespace {

constexpr double kCosineOfCorner = 0.9994;  // 2 degrees

double lengthOf(const Curve& curve) {
    double length = 0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        length += std::hypot(curve.points[i].x - curve.points[i - 1].x,
                             curve.points[i].y - curve.points[i - 1].y);
    }
    return length;
}

struct End {
    std::size_t curve;
    bool atEnd;
};

/// Finds which ends belong together, and follows them.
class CurveJoiner {
  public:
    CurveJoiner(std::vector<Curve> curves, const CurveSampling& sampling)
        : mCurves(std::move(curves)),
          mReach(1e-6 * sampling.size),
          mPartner(2 * mCurves.size(), -1) {}

    std::vector<Curve> join() {
        link();
        std::vector<Curve> result;
        std::vector<bool> used(mCurves.size(), false);
        for (const bool closed : {false, true}) {
            for (std::size_t e = 0; e < mPartner.size(); ++e) {
                const bool isWhole = mCurves[e / 2].closed;
                if (used[e / 2] || (!closed && (mPartner[e] >= 0 || isWhole))) continue;
                result.push_back(isWhole ? mCurves[e / 2] : follow(static_cast<int>(e), used));
                used[e / 2] = true;
                if (closed) result.back().closed = true;
            }
        }
        return result;
    }

  private:
    const CurvePoint& endPoint(std::size_t e) const {
        const auto& points = mCurves[e / 2].points;
        return e % 2 == 0 ? points.front() : points.back();
    }

    // The direction in which a curve leaves through one of its ends.
    std::array<double, 2> leaving(std::size_t e) const {
        const auto& points = mCurves[e / 2].points;
        const std::size_t last = points.size() - 1;
        const auto [x, y] = e % 2 == 0 ? directionTowards(points[0], points[1])
                                       : directionTowards(points[last], points[last - 1]);
        return {-x, -y};
    }

    // How smoothly one end goes on in the other: 1 straight on, -1 back.
    double smoothness(std::size_t a, std::size_t b) const {
        const auto p = leaving(a), q = leaving(b);
        return -(p[0] * q[0] + p[1] * q[1]);
    }

    void link() {
        // Ends by the cell that they are in; the smoothest pairs come first.
        std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
        const auto index = [&](double x) {
            return static_cast<std::int64_t>(std::floor(x / (4 * mReach)));
        };
        const auto key = [&](std::int64_t i, std::int64_t j) {
            return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15U ^
                   static_cast<std::uint64_t>(j);
        };
        std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
        for (std::size_t e = 0; e < mPartner.size(); ++e) {
            if (mCurves[e / 2].closed) continue;
            const CurvePoint& p = endPoint(e);
            const std::int64_t i = index(p.x), j = index(p.y);
            for (int near = 0; near < 9; ++near) {
                const auto found = cells.find(key(i + near % 3 - 1, j + near / 3 - 1));
                if (found == cells.end()) continue;
                for (const std::size_t other : found->second) {
                    const CurvePoint& q = endPoint(other);
                    if (std::hypot(p.x - q.x, p.y - q.y) > mReach) continue;
                    if (std::abs(p.z - q.z) > 100 * mReach) continue;
                    pairs.emplace_back(-smoothness(e, other), other, e);
                }
            }
            cells[key(i, j)].push_back(e);
        }
        std::sort(pairs.begin(), pairs.end());
        for (const auto& [score, a, b] : pairs) {
            if (mPartner[a] >= 0 || mPartner[b] >= 0) continue;
            mPartner[a] = static_cast<int>(b);
            mPartner[b] = static_cast<int>(a);
        }
    }

    Curve follow(int e, std::vector<bool>& used) {
        Curve joined = mCurves[static_cast<std::size_t>(e) / 2];
        joined.points.clear();
        while (e >= 0 && !used[static_cast<std::size_t>(e) / 2]) {
            const auto k = static_cast<std::size_t>(e) / 2;
            used[k] = true;
            auto points = mCurves[k].points;
            if (e % 2 == 1) std::reverse(points.begin(), points.end());
            joined.points.insert(joined.points.end(), points.begin(), points.end());
            e = mPartner[static_cast<std::size_t>(e ^ 1)];
        }
        return joined;
    }

    std::vector<Curve> mCurves;
    double mReach;
    std::vector<int> mPartner;
};

bool isSamePlace(const CurvePoint& a, const CurvePoint& b, double reach) {
    return std::hypot(a.x - b.x, a.y - b.y) <= reach;
}

// The next point in a direction, 1 or -1, that is in another place; i itself if there is none.
std::size_t nextPlace(const Curve& curve, std::size_t i, int step, double reach) {
    const auto& points = curve.points;
    const std::size_t count = points.size();
    for (std::size_t k = 1; k < count; ++k) {
        const std::size_t next = (i + (step > 0 ? k : count - k)) % count;
        const bool isAround = step > 0 ? next < i : next > i;
        if (isAround && !curve.closed) return i;
        if (!isSamePlace(points[next], points[i], reach)) return next;
    }
    return i;
}

// Where the curve turns by more than a little from one point to the next.
void markCorners(Curve& curve, double reach) {
    auto& points = curve.points;
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t b = nextPlace(curve, i, -1, reach), a = nextPlace(curve, i, 1, reach);
        if (a == i || b == i) continue;
        // Points in the same place, first to last, may be on two patches, with directions of their
        // own.
        const std::size_t first = (b + 1) % count, last = (a + count - 1) % count;
        const auto come = directionTowards(points[first], points[b]);
        const auto go = directionTowards(points[last], points[a]);
        // A cusp is in its place already.
        bool isKnown = points[last].corner;
        for (std::size_t k = first; k != last; k = (k + 1) % count) isKnown |= points[k].corner;
        if (!isKnown && -(come[0] * go[0] + come[1] * go[1]) < kCosineOfCorner) {
            points[i].corner = true;
        }
    }
}

}  // namespace

std::array<double, 2> directionTowards(const CurvePoint& at, const CurvePoint& to) {
    const double sign = (to.x - at.x) * at.tx + (to.y - at.y) * at.ty < 0 ? -1 : 1;
    return {sign * at.tx, sign * at.ty};
}

std::vector<Curve> joinCurves(std::vector<Curve> curves, const CurveSampling& sampling) {
    const double reach = 1e-6 * sampling.size;
    std::erase_if(curves, [&](const Curve& curve) {
        return curve.points.size() < 2 || lengthOf(curve) < 0.1 * reach;
    });
    std::vector<Curve> joined = CurveJoiner(std::move(curves), sampling).join();
    for (Curve& curve : joined) markCorners(curve, 0.1 * reach);
    return joined;
}

}  // namespace bandvox
