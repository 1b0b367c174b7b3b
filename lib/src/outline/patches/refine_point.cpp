#include "outline/patches/refine_point.h"

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

// Onto F = 0, along its gradient.
void ontoFold(const ViewPatch& patch, CurvePoint& point) {
    for (int step = 0; step < 8; ++step) {
        const Gradient2 f = evaluate(patch.f, point.u, point.v);
        const double square = f.du * f.du + f.dv * f.dv;
        if (!(square > 0)) return;
        const double du = -f.value * f.du / square, dv = -f.value * f.dv / square;
        point.u = std::clamp(point.u + du, 0.0, 1.0);
        point.v = std::clamp(point.v + dv, 0.0, 1.0);
        // Each step squares the error.
        if (std::max(std::abs(du), std::abs(dv)) < 1e-9) return;
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

}  // namespace

bool meet(std::span<const ViewPatch> patches, CurvePoint& point) {
    const ViewPatch& first = patches[static_cast<std::size_t>(point.patch)];
    const ViewPatch& second = patches[static_cast<std::size_t>(point.other)];
    std::array<double*, 4> parameters{&point.u, &point.v, &point.s, &point.t};
    // Where sides of both patches meet, one of them is enough to hold the point.
    std::array<bool, 4> fixed{};
    for (std::size_t k = 0; k < 4; ++k) {
        fixed[k] = *parameters[k] == 0 || *parameters[k] == 1;
        if (fixed[k]) break;
    }
    for (int step = 0; step < 20; ++step) {
        const ViewPoint p = first.at(point.u, point.v), q = second.at(point.s, point.t);
        const std::array<double, 3> gap{q.x - p.x, q.y - p.y, q.z - p.z};
        const std::array<std::array<double, 3>, 4> columns{
            {{p.xu, p.yu, p.zu}, {p.xv, p.yv, p.zv}, {-q.xu, -q.yu, -q.zu}, {-q.xv, -q.yv, -q.zv}}};
        // The shortest step that closes the gap: J^T (J J^T)^-1 gap.
        std::array<std::array<double, 3>, 3> square{};
        for (std::size_t k = 0; k < 4; ++k) {
            if (fixed[k]) continue;
            for (std::size_t r = 0; r < 3; ++r) {
                for (std::size_t c = 0; c < 3; ++c) square[r][c] += columns[k][r] * columns[k][c];
            }
        }
        std::array<double, 3> weights{};
        if (!solve(square, gap, weights)) return false;
        double largest = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (fixed[k]) continue;
            double move = 0;
            for (std::size_t r = 0; r < 3; ++r) move += columns[k][r] * weights[r];
            largest = std::max(largest, std::abs(move));
            *parameters[k] += std::clamp(move, -0.1, 0.1);
        }
        if (largest < 1e-13) break;
        if (step == 19 && largest > 1e-9) return false;
    }
    for (double* parameter : parameters) *parameter = std::clamp(*parameter, 0.0, 1.0);
    placeMeeting(patches, point);
    return true;
}

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
    if (point.rule == CurveRule::Meeting && meet(patches, point)) return point;
    if (point.rule == CurveRule::Fold) ontoFold(patch, point);
    place(patch, point, b.x - a.x, b.y - a.y);
    return point;
}

}  // namespace bandvox
