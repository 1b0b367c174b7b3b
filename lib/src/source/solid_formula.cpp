#include "source/solid_formula.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr LineInterval kNowhere{kInfinity, -kInfinity};

// The smallest and the largest |x| over [low, high].
struct Range {
    double min, max;
};

Range rangeOfAbs(double low, double high) {
    return {std::max({0.0, low, -high}), std::max(-low, high)};
}

// Where a·t² + 2b·t + c ≤ 0, as up to two intervals. A line that touches counts as crossing in a
// point: the roots' discriminant may fall short of 0 by `slack`·|a|.
std::pair<LineInterval, LineInterval> solveQuadratic(double a, double b, double c, double slack) {
    if (a == 0) {
        LineInterval all{-kInfinity, kInfinity};
        if (b == 0 && c <= slack) return {all, kNowhere};
        all.clip(c, 2 * b);
        return {all, kNowhere};
    }
    const double discriminant = b * b - a * c;
    if (a > 0) {
        if (discriminant < -slack * a) return {kNowhere, kNowhere};
        const double root = std::sqrt(std::max(0.0, discriminant));
        return {{(-b - root) / a, (-b + root) / a}, kNowhere};
    }
    if (discriminant <= 0) return {{-kInfinity, kInfinity}, kNowhere};
    const double root = std::sqrt(discriminant);
    return {{-kInfinity, (-b + root) / a}, {(-b - root) / a, kInfinity}};
}

}  // namespace

void LineInterval::clip(double value, double slope) {
    if (slope > 0) {
        high = std::min(high, -value / slope);
    } else if (slope < 0) {
        low = std::max(low, -value / slope);
    } else if (value > kOnSurface) {
        *this = kNowhere;
    }
}

SolidRow::SolidRow(const Vec3d& first, const Vec3d& toNext, std::span<float> values)
    : start(first), step(toNext), mValues(values) {
    const double length = step.length();
    mSlack = length > 0 ? kOnSurface / length : 0;
    std::fill(values.begin(), values.end(), 0.0F);
}

void SolidRow::fill(const LineInterval& inside) {
    const double first = std::max(0.0, std::ceil(inside.low - mSlack));
    const double last =
        std::min(static_cast<double>(mValues.size()) - 1, std::floor(inside.high + mSlack));
    if (!(first <= last)) return;
    std::fill(mValues.begin() + static_cast<std::ptrdiff_t>(first),
              mValues.begin() + static_cast<std::ptrdiff_t>(last) + 1, 1.0F);
}

LineInterval SolidRow::whole() const {
    return {-1 - mSlack, static_cast<double>(mValues.size()) + mSlack};
}

void BallsFormula::cross(SolidRow& row) const {
    const double a = row.step.lengthSqr();
    for (const Vec3d& center : mCenters) {
        const Vec3d from = row.start - center;
        const double c = from.lengthSqr() - mRadius * mRadius;
        row.fill(solveQuadratic(a, from.dot(row.step), c, 2 * mRadius * kOnSurface).first);
    }
}

std::optional<bool> BallsFormula::constantIn(const BBoxd& box) const {
    bool isOutside = true;
    for (const Vec3d& center : mCenters) {
        double nearest = 0;
        double farthest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Range range =
                rangeOfAbs(box.min()[axis] - center[axis], box.max()[axis] - center[axis]);
            nearest += range.min * range.min;
            farthest += range.max * range.max;
        }
        if (std::sqrt(farthest) <= mRadius - kBoxMargin) return true;
        isOutside = isOutside && std::sqrt(nearest) > mRadius + kBoxMargin;
    }
    return isOutside ? std::optional(false) : std::nullopt;
}

void CubeFormula::cross(SolidRow& row) const {
    LineInterval inside = row.whole();
    for (int axis = 0; axis < 3; ++axis) {
        inside.clip(row.start[axis] - mHalf, row.step[axis]);
        inside.clip(-row.start[axis] - mHalf, -row.step[axis]);
    }
    row.fill(inside);
}

std::optional<bool> CubeFormula::constantIn(const BBoxd& box) const {
    bool isInside = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Range range = rangeOfAbs(box.min()[axis], box.max()[axis]);
        if (range.min > mHalf + kBoxMargin) return false;
        isInside = isInside && range.max <= mHalf - kBoxMargin;
    }
    return isInside ? std::optional(true) : std::nullopt;
}

bool TorusFormula::contains(const Vec3d& p) const {
    const double r = std::hypot(p.x(), p.z()) - mRing;
    return std::hypot(r, p.y()) <= mTube + kOnSurface;
}

void TorusFormula::cross(SolidRow& row) const {
    const Vec3d& step = row.step;
    const auto isAlong = [&](int axis) {
        return step[axis] != 0 && step[(axis + 1) % 3] == 0 && step[(axis + 2) % 3] == 0;
    };
    if (isAlong(1)) return crossAlong(row);
    if (isAlong(0) || isAlong(2)) return crossAcross(row, isAlong(0) ? 0 : 2);
    // Any other line meets a quartic; look at each point.
    for (std::size_t i = 0; i < row.size(); ++i) {
        const auto t = static_cast<double>(i);
        if (contains(row.start + t * step)) row.fill({t, t});
    }
}

// A line along x or z: at its height the torus is a ring between two circles.
void TorusFormula::crossAcross(SolidRow& row, int axis) const {
    const double y = row.start.y();
    const double across = row.start[2 - axis];
    if (std::abs(y) > mTube + kOnSurface) return;
    const double half = std::sqrt(std::max(0.0, mTube * mTube - y * y));
    const auto squareAt = [&](double radius) { return radius * radius - across * across; };
    const double outer = squareAt(mRing + half);
    if (outer < -2 * mRing * kOnSurface) return;
    const double far = std::sqrt(std::max(0.0, outer));
    const double near = std::sqrt(std::max(0.0, squareAt(mRing - half)));
    const auto fill = [&](double low, double high) {
        const double a = (low - row.start[axis]) / row.step[axis];
        const double b = (high - row.start[axis]) / row.step[axis];
        row.fill({std::min(a, b), std::max(a, b)});
    };
    fill(-far, -near);
    fill(near, far);
}

// A line along the axis: it crosses the tube once.
void TorusFormula::crossAlong(SolidRow& row) const {
    const double r = std::hypot(row.start.x(), row.start.z()) - mRing;
    if (std::abs(r) > mTube + kOnSurface) return;
    const double half = std::sqrt(std::max(0.0, mTube * mTube - r * r));
    LineInterval inside = row.whole();
    inside.clip(row.start.y() - half, row.step.y());
    inside.clip(-row.start.y() - half, -row.step.y());
    row.fill(inside);
}

std::optional<bool> TorusFormula::constantIn(const BBoxd& box) const {
    const Range x = rangeOfAbs(box.min().x(), box.max().x());
    const Range y = rangeOfAbs(box.min().y(), box.max().y());
    const Range z = rangeOfAbs(box.min().z(), box.max().z());
    const Range r = rangeOfAbs(std::hypot(x.min, z.min) - mRing, std::hypot(x.max, z.max) - mRing);
    if (std::hypot(r.min, y.min) > mTube + kBoxMargin) return false;
    if (std::hypot(r.max, y.max) <= mTube - kBoxMargin) return true;
    return std::nullopt;
}

void HyperboloidFormula::cross(SolidRow& row) const {
    const Vec3d& p = row.start;
    const Vec3d& s = row.step;
    const double m = mSlope * mSlope;
    const double a = s.x() * s.x() + s.z() * s.z() - m * s.y() * s.y();
    const double b = p.x() * s.x() + p.z() * s.z() - m * p.y() * s.y();
    const double c = p.x() * p.x() + p.z() * p.z() - m * p.y() * p.y() - mWaist * mWaist;
    const auto [first, second] = solveQuadratic(a, b, c, 2 * mWaist * kOnSurface);
    for (LineInterval inside : {first, second}) {
        inside.clip(p.y() - 1, s.y());
        inside.clip(-p.y() - 1, -s.y());
        row.fill(inside);
    }
}

std::optional<bool> HyperboloidFormula::constantIn(const BBoxd& box) const {
    const Range x = rangeOfAbs(box.min().x(), box.max().x());
    const Range y = rangeOfAbs(box.min().y(), box.max().y());
    const Range z = rangeOfAbs(box.min().z(), box.max().z());
    const auto radiusAt = [&](double height) { return std::hypot(mWaist, mSlope * height); };
    if (y.min > 1 + kBoxMargin) return false;
    // Beyond the ends the hyperbola goes on, which only makes the test say less.
    if (std::hypot(x.min, z.min) > radiusAt(y.max) + kBoxMargin) return false;
    if (y.max <= 1 - kBoxMargin && std::hypot(x.max, z.max) <= radiusAt(y.min) - kBoxMargin) {
        return true;
    }
    return std::nullopt;
}

}  // namespace bandvox
