#include "outline/patches/refine_point.h"

#include "outline/patches/onto_zero.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox {
namespace {

void place(const ViewPatch& patch, CurvePoint& point, double dx, double dy) {
    const ViewPoint p = patch.at(point.u, point.v);
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    if (point.rule == CurveRule::Fold) {
        const auto [tx, ty] = foldDirection(p);
        point.tx = tx;
        point.ty = ty;
        return;
    }
    const double length = std::hypot(dx, dy);
    if (length > 0) {
        point.tx = dx / length;
        point.ty = dy / length;
    }
}

// Solves the 3 x 3 system by Cramer's rule; false if it has no solution.
bool solve(const std::array<std::array<double, 3>, 3>& a, const std::array<double, 3>& b,
           std::array<double, 3>& x) {
    const auto determinant = [](const std::array<std::array<double, 3>, 3>& m) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    const double whole = determinant(a);
    if (whole == 0 || !std::isfinite(whole)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        auto column = a;
        for (std::size_t r = 0; r < 3; ++r) column[r][k] = b[r];
        x[k] = determinant(column) / whole;
    }
    return true;
}

std::array<double*, 4> parametersOf(CurvePoint& point) {
    return {&point.u, &point.v, &point.s, &point.t};
}

// Puts a point of an intersection, (u, v) and (s, t) of two patches, where both are in the same
// place, as near as possible to where it was. False if that fails.
bool meet(std::span<const ViewPatch> patches, CurvePoint& point) {
    const ViewPatch& first = patches[static_cast<std::size_t>(point.patch)];
    const ViewPatch& second = patches[static_cast<std::size_t>(point.other)];
    const std::array<double*, 4> parameters = parametersOf(point);
    for (int step = 0; step < 20; ++step) {
        const ViewPoint p = first.at(point.u, point.v), q = second.at(point.s, point.t);
        const std::array<double, 3> gap{q.x - p.x, q.y - p.y, q.z - p.z};
        const std::array<std::array<double, 3>, 4> columns{
            {{p.xu, p.yu, p.zu}, {p.xv, p.yv, p.zv}, {-q.xu, -q.yu, -q.zu}, {-q.xv, -q.yv, -q.zv}}};
        // The shortest step that closes the gap: J^T (J J^T)^-1 gap.
        std::array<std::array<double, 3>, 3> square{};
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t r = 0; r < 3; ++r) {
                for (std::size_t c = 0; c < 3; ++c) square[r][c] += columns[k][r] * columns[k][c];
            }
        }
        std::array<double, 3> weights{};
        if (!solve(square, gap, weights)) return false;
        double largest = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            double move = 0;
            for (std::size_t r = 0; r < 3; ++r) move += columns[k][r] * weights[r];
            largest = std::max(largest, std::abs(move));
            *parameters[k] += std::clamp(move, -0.1, 0.1);
        }
        if (largest < 1e-13) break;
        if (step == 19 && largest > 1e-9) return false;
    }
    for (double* parameter : parameters) *parameter = std::clamp(*parameter, 0.0, 1.0);
    return true;
}

}  // namespace

void placeMeeting(std::span<const ViewPatch> patches, CurvePoint& point) {
    const ViewPatch& first = patches[static_cast<std::size_t>(point.patch)];
    const ViewPoint p = first.at(point.u, point.v),
                    q = patches[static_cast<std::size_t>(point.other)].at(point.s, point.t);
    // Along the curve both surfaces go: across both normals.
    const auto normal = [](const ViewPoint& a) {
        return std::array{a.yu * a.zv - a.zu * a.yv, a.zu * a.xv - a.xu * a.zv,
                          a.xu * a.yv - a.yu * a.xv};
    };
    const auto n = normal(p), m = normal(q);
    point.rule = CurveRule::Meeting;
    place(first, point, n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2]);
}

CurvePoint pointBetween(std::span<const ViewPatch> patches, const CurvePoint& a,
                        const CurvePoint& b, double share) {
    CurvePoint point = share < 0.5 ? a : b;
    if (a.patch != b.patch || a.rule != b.rule || a.other != b.other) return point;
    point.corner = false;
    const auto between = [&](double from, double to) { return from + share * (to - from); };
    point.u = between(a.u, b.u);
    point.v = between(a.v, b.v);
    point.s = between(a.s, b.s);
    point.t = between(a.t, b.t);
    const ViewPatch& patch = patches[static_cast<std::size_t>(a.patch)];
    if (point.rule == CurveRule::Meeting && meet(patches, point)) {
        // A curve that lies on a side is not held there while the point is sought: that would leave
        // nothing to tell where along it.
        CurvePoint begin = a, end = b;
        const auto from = parametersOf(begin), to = parametersOf(end), here = parametersOf(point);
        for (std::size_t k = 0; k < 4; ++k) {
            const bool isOnSide = *from[k] == *to[k] && (*from[k] == 0 || *from[k] == 1);
            if (isOnSide) *here[k] = *from[k];
        }
        placeMeeting(patches, point);
        return point;
    }
    if (point.rule == CurveRule::Fold) {
        // Where F has no gradient both ends are as good.
        ontoZero([&](double u, double v) { return evaluate(patch.f, u, v); }, point.u, point.v);
    }
    place(patch, point, b.x - a.x, b.y - a.y);
    return point;
}

}  // namespace bandvox
