#include "outline/net_meetings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>

namespace bandvox {
namespace {

using Vec = std::array<double, 3>;

Vec minus(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Six times the volume that a triangle spans with a point: on which side of it the point is.
double side(const Vec& a, const Vec& b, const Vec& c, const Vec& p) {
    return dot(cross(minus(b, a), minus(c, a)), minus(p, a));
}

/// A triangle of a net: corners by their number in it.
struct NetTriangle {
    int net = 0;
    std::array<int, 3> corners{};
    Vec low{}, high{};
};

/// What names a place: an edge of one net, and a triangle of another one.
using PlaceKey = std::tuple<int, int, int, std::size_t>;

struct FoundPlace {
    PlaceKey key;
    NetMeeting place;
};

class NetSearch {
  public:
    explicit NetSearch(std::span<const PatchNet> nets) : mNets(nets) { makeTriangles(); }

    std::vector<NetMeetings> search() {
        for (const auto& [cell, members] : mCells) {
            for (std::size_t i = 0; i < members.size(); ++i) {
                for (std::size_t j = i + 1; j < members.size(); ++j) {
                    examine(members[i], members[j], cell);
                }
            }
        }
        std::vector<NetMeetings> chains;
        for (auto& [pair, segments] : mSegments) appendChains(pair, segments, chains);
        return chains;
    }

  private:
    using Cell = std::uint64_t;
    using Segment = std::array<FoundPlace, 2>;

    void makeTriangles() {
        Vec low{}, high{};
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
        double extent = 0;
        for (int n = 0; n < static_cast<int>(mNets.size()); ++n) {
            const int steps = mNets[static_cast<std::size_t>(n)].steps;
            for (int i = 0; i < steps; ++i) {
                for (int j = 0; j < steps; ++j) {
                    const int a = i * (steps + 1) + j, b = a + steps + 1;
                    addTriangle(n, {a, b, b + 1});
                    addTriangle(n, {a, b + 1, a + 1});
                }
            }
        }
        for (const NetTriangle& t : mTriangles) {
            for (std::size_t c = 0; c < 3; ++c) {
                low[c] = std::min(low[c], t.low[c]);
                high[c] = std::max(high[c], t.high[c]);
                extent += (t.high[c] - t.low[c]) / 3;
            }
        }
        const double whole = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
        mSame = 1e-9 * whole;
        mCellSize =
            std::max({1.5 * extent / static_cast<double>(mTriangles.size()), whole / 500, 1e-300});
        for (std::size_t k = 0; k < mTriangles.size(); ++k) addToCells(k);
    }

    void addTriangle(int net, const std::array<int, 3>& corners) {
        NetTriangle t{net, corners, {}, {}};
        t.low = t.high = corner(t, 0);
        for (std::size_t k = 1; k < 3; ++k) {
            const Vec& p = corner(t, k);
            for (std::size_t c = 0; c < 3; ++c) {
                t.low[c] = std::min(t.low[c], p[c]);
                t.high[c] = std::max(t.high[c], p[c]);
            }
        }
        const Vec normal =
            cross(minus(corner(t, 1), corner(t, 0)), minus(corner(t, 2), corner(t, 0)));
        // Where a side of a patch is a point, triangles have no area.
        if (dot(normal, normal) > 0) mTriangles.push_back(t);
    }

    const Vec& corner(const NetTriangle& t, std::size_t k) const {
        return mNets[static_cast<std::size_t>(t.net)]
            .points[static_cast<std::size_t>(t.corners[k])];
    }

    std::array<std::int64_t, 3> cellOf(const Vec& p) const {
        return {std::int64_t(std::floor(p[0] / mCellSize)),
                std::int64_t(std::floor(p[1] / mCellSize)),
                std::int64_t(std::floor(p[2] / mCellSize))};
    }
    static Cell keyOf(std::int64_t i, std::int64_t j, std::int64_t k) {
        constexpr std::uint64_t kMask = (1U << 21U) - 1;
        return (static_cast<std::uint64_t>(i) & kMask) << 42U |
               (static_cast<std::uint64_t>(j) & kMask) << 21U |
               (static_cast<std::uint64_t>(k) & kMask);
    }

    void addToCells(std::size_t index) {
        const auto first = cellOf(mTriangles[index].low), last = cellOf(mTriangles[index].high);
        for (std::int64_t i = first[0]; i <= last[0]; ++i) {
            for (std::int64_t j = first[1]; j <= last[1]; ++j) {
                for (std::int64_t k = first[2]; k <= last[2]; ++k) {
                    mCells[keyOf(i, j, k)].push_back(index);
                }
            }
        }
    }

    bool sharesCorner(const NetTriangle& a, const NetTriangle& b) const {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                const Vec d = minus(corner(a, i), corner(b, j));
                if (std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}) <= mSame)
                    return true;
            }
        }
        return false;
    }

    void examine(std::size_t i, std::size_t j, Cell cell) {
        const NetTriangle &a = mTriangles[i], &b = mTriangles[j];
        Vec low{};
        for (std::size_t c = 0; c < 3; ++c) {
            if (a.low[c] > b.high[c] || b.low[c] > a.high[c]) return;
            low[c] = std::max(a.low[c], b.low[c]);
        }
        // A pair that shares several cells is looked at in the first of them.
        const auto owner = cellOf(low);
        if (keyOf(owner[0], owner[1], owner[2]) != cell || sharesCorner(a, b)) return;
        std::vector<FoundPlace> found;
        pierce(a, b, j, false, found);
        pierce(b, a, i, true, found);
        addSegment({a.net, b.net}, found);
    }

    static double distance(const NetMeeting& a, const NetMeeting& b) {
        return std::max(
            {std::abs(a.u - b.u), std::abs(a.v - b.v), std::abs(a.s - b.s), std::abs(a.t - b.t)});
    }

    // Where edges meet edges, as in the plane of symmetry of two objects, a place is found twice:
    // those that are farthest apart are the ends.
    void addSegment(const std::pair<int, int>& pair, const std::vector<FoundPlace>& found) {
        constexpr double kNoLength = 1e-6;
        double longest = kNoLength;
        std::optional<Segment> best;
        for (std::size_t i = 0; i < found.size(); ++i) {
            for (std::size_t j = i + 1; j < found.size(); ++j) {
                const double length = distance(found[i].place, found[j].place);
                if (length <= longest) continue;
                longest = length;
                best = Segment{found[i], found[j]};
            }
        }
        if (best) mSegments[pair].push_back(*best);
    }

    // Edges of a that go through b. `swapped`: a is the second of the pair.
    void pierce(const NetTriangle& a, const NetTriangle& b, std::size_t indexOfB, bool swapped,
                std::vector<FoundPlace>& found) const {
        const Vec &p = corner(b, 0), &q = corner(b, 1), &r = corner(b, 2);
        std::array<double, 3> sides{};
        for (std::size_t k = 0; k < 3; ++k) sides[k] = side(p, q, r, corner(a, k));
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t from = k, to = (k + 1) % 3;
            if ((sides[from] >= 0) == (sides[to] >= 0)) continue;
            // Whichever triangle an edge belongs to, it is computed alike.
            if (a.corners[from] > a.corners[to]) std::swap(from, to);
            const Vec &e = corner(a, from), &f = corner(a, to);
            const double x = side(e, f, p, q), y = side(e, f, q, r), z = side(e, f, r, p);
            // What rounding puts beside the triangle's edge lies on it.
            constexpr double kRounding = 1e-9;
            const double sum = x + y + z;
            if (sum == 0 || std::min({x / sum, y / sum, z / sum}) < -kRounding) continue;
            const double share = sides[from] / (sides[from] - sides[to]);
            const auto onA = between(a, from, to, share);
            const auto onB = weighted(b, {y / sum, z / sum, x / sum});
            FoundPlace place;
            place.key = {a.net, a.corners[from], a.corners[to], indexOfB};
            place.place = swapped ? NetMeeting{onB[0], onB[1], onA[0], onA[1]}
                                  : NetMeeting{onA[0], onA[1], onB[0], onB[1]};
            found.push_back(place);
        }
    }

    std::array<double, 2> parameters(const NetTriangle& t, std::size_t k) const {
        const int steps = mNets[static_cast<std::size_t>(t.net)].steps;
        const int u = t.corners[k] / (steps + 1), v = t.corners[k] % (steps + 1);
        return {double(u) / steps, double(v) / steps};
    }
    std::array<double, 2> between(const NetTriangle& t, std::size_t from, std::size_t to,
                                  double share) const {
        const auto a = parameters(t, from), b = parameters(t, to);
        return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
    }
    std::array<double, 2> weighted(const NetTriangle& t, const Vec& weights) const {
        std::array<double, 2> sum{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto p = parameters(t, k);
            for (std::size_t c = 0; c < 2; ++c) sum[c] += weights[k] * p[c];
        }
        return sum;
    }

    static void appendChains(const std::pair<int, int>& pair, const std::vector<Segment>& segments,
                             std::vector<NetMeetings>& chains) {
        std::map<PlaceKey, std::vector<std::size_t>> at;
        for (std::size_t k = 0; k < segments.size(); ++k) {
            for (const FoundPlace& place : segments[k]) at[place.key].push_back(k);
        }
        std::vector<bool> used(segments.size(), false);
        for (const bool closed : {false, true}) {
            for (std::size_t k = 0; k < segments.size(); ++k) {
                for (std::size_t e = 0; e < 2 && !used[k]; ++e) {
                    if (!closed && at[segments[k][e].key].size() != 1) continue;
                    NetMeetings chain{pair.first, pair.second, closed, {}};
                    follow(k, e, segments, at, used, chain.places);
                    chains.push_back(std::move(chain));
                }
            }
        }
    }

    static void follow(std::size_t k, std::size_t e, const std::vector<Segment>& segments,
                       std::map<PlaceKey, std::vector<std::size_t>>& at, std::vector<bool>& used,
                       std::vector<NetMeeting>& places) {
        places.push_back(segments[k][e].place);
        while (true) {
            used[k] = true;
            const FoundPlace& next = segments[k][1 - e];
            places.push_back(next.place);
            const auto& others = at[next.key];
            const auto other =
                std::find_if(others.begin(), others.end(), [&](std::size_t o) { return !used[o]; });
            if (other == others.end()) return;
            k = *other;
            e = segments[k][0].key == next.key ? 0 : 1;
        }
    }

    std::span<const PatchNet> mNets;
    std::vector<NetTriangle> mTriangles;
    std::unordered_map<Cell, std::vector<std::size_t>> mCells;
    std::map<std::pair<int, int>, std::vector<Segment>> mSegments;
    double mCellSize = 1;
    double mSame = 0;
};

}  // namespace

std::vector<NetMeetings> netMeetings(std::span<const PatchNet> nets) {
    return NetSearch(nets).search();
}

}  // namespace bandvox
