#include "outline/volumes/space_curve.h"

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// Voxels; beyond this, single precision ends.
constexpr double kExact = 1e-6, kExactEnough = 1e-3;

// What functions are off by where they jump from voxel to voxel, relative to the gradient: voxels,
// and the angle at which the surface is seen.
constexpr double kReadPlace = 1e-4, kReadAngle = 1e-4;

// Gradients at a smaller angle than this have no direction across both.
constexpr double kSmallestSine = 1e-5;

// The shortest move that makes both functions 0, to first order.
std::optional<Vec3d> newtonMove(const SpacePoint& p) {
    const double ff = p.df.dot(p.df), gg = p.dg.dot(p.dg), fg = p.df.dot(p.dg);
    const double area = ff * gg - fg * fg;
    if (!(area > kSmallestSine * kSmallestSine * ff * gg)) return std::nullopt;
    const double a = (p.f * gg - p.g * fg) / area, b = (p.g * ff - p.f * fg) / area;
    return -(a * p.df + b * p.dg);
}

}  // namespace

Vec3d SpacePoint::tangent() const {
    const Vec3d across = df.cross(dg);
    const double length = across.length();
    if (!(length > kSmallestSine * df.length() * dg.length())) return Vec3d(0.0);
    return across / length;
}

std::optional<SpacePoint> ontoCurve(CurveEquations& equations, const Vec3d& near, double reach) {
    constexpr int kMostSteps = 12;
    constexpr double kLongestMove = 0.5;
    SpacePoint p = equations.at(near);
    double before = reach;
    for (int step = 0; step < kMostSteps; ++step) {
        const auto move = newtonMove(p);
        if (!move) return std::nullopt;
        const double length = move->length();
        if (length < kExact) return p;
        // What no longer gets better is as good as it can be.
        if (length < kExactEnough && length > 0.5 * before) return p;
        const Vec3d next = p.at + *move * std::min(1.0, kLongestMove / length);
        if (!((next - near).length() <= reach)) return std::nullopt;
        p = equations.at(next);
        before = length;
    }
    const double slope = p.df.length();
    const bool isGood = std::abs(p.f) < kReadPlace * slope && std::abs(p.g) < kReadAngle * slope;
    return isGood ? std::optional(p) : std::nullopt;
}

std::optional<SpacePoint> spaceBetween(CurveEquations& equations, const Vec3d& a, const Vec3d& b,
                                       double share) {
    return ontoCurve(equations, a + share * (b - a), std::max(0.1, (b - a).length()));
}

}  // namespace bandvox
