#include "outline/patches/meeting_march.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

constexpr double kInside = 1e-11;       // by which a parameter may be beyond a border
constexpr double kStraight = 0.98;      // cosine of the largest turn in a step
constexpr double kLongestStep = 0.04;   // of the page
constexpr double kShortestStep = 1e-8;  // of the page
constexpr int kMostSteps = 20000;

using Row4 = std::array<double, 4>;

double dot4(const Row4& a, const Row4& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

double determinant3(const std::array<Row4, 3>& m, std::size_t a, std::size_t b, std::size_t c) {
    return m[0][a] * (m[1][b] * m[2][c] - m[1][c] * m[2][b]) -
           m[0][b] * (m[1][a] * m[2][c] - m[1][c] * m[2][a]) +
           m[0][c] * (m[1][a] * m[2][b] - m[1][b] * m[2][a]);
}

// Gauss's elimination with pivots; false if there is no solution.
bool solve4(std::array<Row4, 4> m, Row4 b, Row4& x) {
    for (std::size_t k = 0; k < 4; ++k) {
        std::size_t pivot = k;
        for (std::size_t r = k + 1; r < 4; ++r) {
            if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
        }
        if (!(std::abs(m[pivot][k]) > 0)) return false;
        std::swap(m[k], m[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t r = k + 1; r < 4; ++r) {
            const double factor = m[r][k] / m[k][k];
            for (std::size_t c = k; c < 4; ++c) m[r][c] -= factor * m[k][c];
            b[r] -= factor * b[k];
        }
    }
    for (std::size_t k = 4; k-- > 0;) {
        double sum = b[k];
        for (std::size_t c = k + 1; c < 4; ++c) sum -= m[k][c] * x[c];
        x[k] = sum / m[k][k];
    }
    return std::isfinite(x[0] + x[1] + x[2] + x[3]);
}

bool isInsidePatches(const MeetingPlace& p) {
    return std::all_of(p.begin(), p.end(),
                       [](double x) { return x >= -kInside && x <= 1 + kInside; });
}

MeetingPlace clampedTo(MeetingPlace p) {
    for (double& x : p) x = std::clamp(x, 0.0, 1.0);
    return p;
}

bool isNearBorder(double u, double v) {
    constexpr double kNear = 1e-6;
    return std::min({u, 1 - u, v, 1 - v}) < kNear;
}

// The mean length of the derivative by a parameter.
double meanSlope(const ViewPatch& patch, bool byU) {
    double sum = 0;
    for (const double u : {0.1, 0.5, 0.9}) {
        for (const double v : {0.1, 0.5, 0.9}) {
            const ViewPoint p = patch.at(u, v);
            sum += byU ? std::hypot(p.xu, p.yu, p.zu) : std::hypot(p.xv, p.yv, p.zv);
        }
    }
    return sum / 9;
}

}  // namespace

MeetingMarch::MeetingMarch(const ViewPatch& a, const ViewPatch& b, bool shares, double size)
    : mA(a),
      mB(b),
      mShares(shares),
      mIsSelf(&a == &b),
      mSize(size),
      mWeights{meanSlope(a, true), meanSlope(a, false), meanSlope(b, true), meanSlope(b, false)} {
    for (double& weight : mWeights) weight = std::max(weight, 1e-9 * size);
}

std::array<MeetingMarch::Row, 3> MeetingMarch::jacobian(const MeetingPlace& at,
                                                        std::array<double, 3>& gap) const {
    const ViewPoint p = mA.at(at[0], at[1]), q = mB.at(at[2], at[3]);
    gap = {q.x - p.x, q.y - p.y, q.z - p.z};
    std::array<Row, 3> rows{
        {{p.xu, p.xv, -q.xu, -q.xv}, {p.yu, p.yv, -q.yu, -q.yv}, {p.zu, p.zv, -q.zu, -q.zv}}};
    for (Row& row : rows) {
        for (std::size_t k = 0; k < 4; ++k) row[k] /= mWeights[k];
    }
    return rows;
}

// What both patches' differences do not see.
MeetingMarch::Row MeetingMarch::tangentAt(const MeetingPlace& p, double* opening) const {
    std::array<double, 3> gap{};
    const auto j = jacobian(p, gap);
    Row t{determinant3(j, 1, 2, 3), -determinant3(j, 0, 2, 3), determinant3(j, 0, 1, 3),
          -determinant3(j, 0, 1, 2)};
    const double length = std::sqrt(dot4(t, t));
    if (opening != nullptr) *opening = length;
    for (double& x : t) x = length > 0 ? x / length : 0;
    return t;
}

bool MeetingMarch::isProper(const MeetingPlace& p) const {
    if (!isInsidePatches(p)) return false;
    if (mShares && isNearBorder(p[0], p[1]) && isNearBorder(p[2], p[3])) return false;
    constexpr double kSame = 1e-4;
    if (mIsSelf && std::max(std::abs(p[0] - p[2]), std::abs(p[1] - p[3])) < kSame) return false;
    const auto normal = [](const ViewPoint& q) {
        const std::array<double, 3> n{q.yu * q.zv - q.zu * q.yv, q.zu * q.xv - q.xu * q.zv,
                                      q.xu * q.yv - q.yu * q.xv};
        const double length = std::hypot(n[0], n[1], n[2]);
        return std::array{n[0] / length, n[1] / length, n[2] / length};
    };
    const auto n = normal(mA.at(p[0], p[1])), m = normal(mB.at(p[2], p[3]));
    const double sine =
        std::hypot(n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]);
    // Surfaces that touch do not pass through each other.
    constexpr double kLeastAngle = 1e-5;
    return sine > kLeastAngle;
}

// Newton's method in the plane across `row` through `base`; without a row by the shortest steps.
bool MeetingMarch::converge(MeetingPlace& p, std::optional<Row> row,
                            const MeetingPlace& base) const {
    const double near = 1e-12 * mSize;
    double moved = 0;
    for (int step = 0; step < 14; ++step) {
        std::array<double, 3> gap{};
        const auto j = jacobian(p, gap);
        Row across = row ? *row : tangentAt(p), d{};
        const double behind = row ? dot4(*row, lengths(p, base)) : 0;
        if (!solve4({j[0], j[1], j[2], across}, {gap[0], gap[1], gap[2], behind}, d)) return false;
        moved = std::sqrt(dot4(d, d));
        for (std::size_t k = 0; k < 4; ++k) p[k] += d[k] / mWeights[k];
        for (const double x : p) {
            if (x < -0.5 || x > 1.5) return false;
        }
        if (moved < near) return true;
    }
    std::array<double, 3> gap{};
    jacobian(p, gap);
    return moved < 1e-6 * mSize && std::hypot(gap[0], gap[1], gap[2]) < 1e-10 * mSize;
}

MeetingMarch::Row MeetingMarch::lengths(const MeetingPlace& from, const MeetingPlace& to) const {
    Row row{};
    for (std::size_t k = 0; k < 4; ++k) row[k] = (to[k] - from[k]) * mWeights[k];
    return row;
}

std::optional<MeetingPlace> MeetingMarch::settled(const MeetingPlace& guess) const {
    MeetingPlace p = guess;
    if (!converge(p, std::nullopt, p) || !isProper(p)) return std::nullopt;
    return clampedTo(p);
}

std::optional<MeetingPlace> MeetingMarch::settledOnSide(const MeetingPlace& guess,
                                                        std::size_t k) const {
    Row row{};
    row[k] = 1;
    MeetingPlace p = guess;
    if (!converge(p, row, guess)) return std::nullopt;
    p[k] = guess[k];
    if (!isProper(p)) return std::nullopt;
    return clampedTo(p);
}

// One step along the curve; none if it is too long to be safe.
std::optional<MeetingMarch::Step> MeetingMarch::advanced(const Step& from, double length) const {
    MeetingPlace guess = from.place;
    for (std::size_t k = 0; k < 4; ++k) guess[k] += length * from.tangent[k] / mWeights[k];
    Step next{guess, {}, 0};
    if (!converge(next.place, from.tangent, guess)) return std::nullopt;
    const Row aside = lengths(guess, next.place);
    if (dot4(aside, aside) > 0.01 * length * length) return std::nullopt;
    next.tangent = tangentAt(next.place, &next.opening);
    const double cosine = dot4(next.tangent, from.tangent);
    if (cosine < 0) {
        for (double& x : next.tangent) x = -x;
    }
    if (std::abs(cosine) < kStraight) return std::nullopt;
    return next;
}

// Whether a step comes back to where the walk began.
bool MeetingMarch::closes(const Step& from, double length, const MeetingPlace& start) const {
    const Row ahead = lengths(from.place, start);
    const double along = dot4(ahead, from.tangent);
    if (along <= 0 || along > length || dot4(ahead, ahead) > 1.1 * along * along) return false;
    const auto there = advanced(from, along);
    if (!there) return false;
    const Row gap = lengths(there->place, start);
    return dot4(gap, gap) < 1e-16 * mSize * mSize;
}

// Where the curve leaves the patches between a place inside and one outside.
std::optional<MeetingPlace> MeetingMarch::leftBetween(const MeetingPlace& a,
                                                      const MeetingPlace& b) const {
    std::vector<std::pair<double, std::size_t>> leaves;
    for (std::size_t k = 0; k < 4; ++k) {
        if (b[k] >= -kInside && b[k] <= 1 + kInside) continue;
        const double border = b[k] < 0 ? 0 : 1;
        leaves.emplace_back((border - a[k]) / (b[k] - a[k]), k);
    }
    std::sort(leaves.begin(), leaves.end());
    for (const auto& [share, k] : leaves) {
        MeetingPlace p = a;
        for (std::size_t i = 0; i < 4; ++i) p[i] += share * (b[i] - a[i]);
        p[k] = b[k] < 0 ? 0 : 1;
        const double border = p[k];
        Row row{};
        row[k] = 1;
        if (!converge(p, row, p)) continue;
        p[k] = border;
        if (isInsidePatches(p)) return clampedTo(p);
    }
    return std::nullopt;
}

// Where branches nearly cross the angle between the patches goes down to almost nothing, in
// proportion to the way that is left: steps are no longer than half of that.
double MeetingMarch::safeLength(const Step& from, const Step& to, double apart) const {
    const double closing = (from.opening - to.opening) / apart;
    const double longest = kLongestStep * mSize;
    return closing > 0 ? std::min(longest, 0.5 * to.opening / closing) : longest;
}

MeetingMarch::Walk MeetingMarch::walk(const MeetingPlace& start, const Row& direction) const {
    Walk result;
    Step here{start, direction, 0};
    tangentAt(start, &here.opening);
    double length = 0.25 * kLongestStep * mSize;
    const double little = 1e-4 * length;
    if (const auto trial = advanced(here, little)) {
        length = std::min(length, safeLength(here, *trial, little));
    }
    for (int step = 0; step < kMostSteps && length > kShortestStep * mSize; ++step) {
        const auto next = advanced(here, length);
        if (!next) {
            length *= 0.5;
            continue;
        }
        if (result.places.size() > 2 && closes(here, length, start)) {
            result.places.push_back(start);
            result.closed = true;
            return result;
        }
        if (!isInsidePatches(next->place)) {
            if (const auto left = leftBetween(here.place, next->place)) {
                result.places.push_back(*left);
                return result;
            }
            length *= 0.5;
            continue;
        }
        // Where a patch no more meets itself: at a pinch.
        const MeetingPlace& p = next->place;
        constexpr double kPinch = 1e-5;
        if (mIsSelf && std::max(std::abs(p[0] - p[2]), std::abs(p[1] - p[3])) < kPinch) break;
        const double safe = safeLength(here, *next, length);
        if (dot4(next->tangent, here.tangent) > 0.5 * (1 + kStraight)) length *= 1.5;
        length = std::min(length, safe);
        here = *next;
        result.places.push_back(here.place);
    }
    return result;
}

MeetingBranch MeetingMarch::follow(const MeetingPlace& seed) const {
    const Row ahead = tangentAt(seed);
    Row back = ahead;
    for (double& x : back) x = -x;
    MeetingBranch branch;
    const auto leaves = [&](const Row& direction) {
        for (std::size_t k = 0; k < 4; ++k) {
            constexpr double kAway = 1e-9;
            if ((seed[k] == 0 && direction[k] < -kAway) || (seed[k] == 1 && direction[k] > kAway)) {
                return true;
            }
        }
        return false;
    };
    Walk first, second;
    if (!leaves(ahead)) first = walk(seed, ahead);
    if (!first.closed && !leaves(back)) second = walk(seed, back);
    branch.closed = first.closed || second.closed;
    if (second.closed) first.places.clear();
    branch.places.assign(second.places.rbegin(), second.places.rend());
    branch.places.push_back(seed);
    branch.places.insert(branch.places.end(), first.places.begin(), first.places.end());
    return branch;
}

bool MeetingMarch::isOn(const MeetingBranch& branch, const MeetingPlace& place) const {
    const double same = 1e-7 * mSize;
    for (std::size_t i = 1; i < branch.places.size(); ++i) {
        const MeetingPlace& a = branch.places[i - 1];
        Row along = lengths(a, branch.places[i]);
        const Row ahead = lengths(a, place);
        const double length = std::sqrt(dot4(along, along));
        const double share = length > 0 ? dot4(ahead, along) / (length * length) : 0;
        if (share < -0.1 || share > 1.1) continue;
        double aside = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double off = ahead[k] - share * along[k];
            aside += off * off;
        }
        if (aside > 0.01 * length * length + same * same) continue;
        for (double& x : along) x /= std::max(length, 1e-300);
        MeetingPlace near = a;
        for (std::size_t k = 0; k < 4; ++k) near[k] += share * (branch.places[i][k] - a[k]);
        if (!converge(near, along, place)) continue;
        const Row gap = lengths(near, place);
        if (dot4(gap, gap) < same * same) return true;
    }
    return false;
}

}  // namespace bandvox
