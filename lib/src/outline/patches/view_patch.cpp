#include "outline/patches/view_patch.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

bool isConstant(const Bernstein2& p) {
    const auto [low, high] = std::minmax_element(p.c.begin(), p.c.end());
    return *high - *low <= 1e-14 * std::abs(*high);
}

Bernstein2 foldFunction(const ViewPatch& p) {
    const Bernstein2 xu = derivativeU(p.x), xv = derivativeV(p.x);
    const Bernstein2 yu = derivativeU(p.y), yv = derivativeV(p.y);
    Bernstein2 area = xu * yv - xv * yu;
    if (p.w.m == 0 && p.w.n == 0) return area;
    const Bernstein2 wu = derivativeU(p.w), wv = derivativeV(p.w);
    return p.w * area + p.x * (yu * wv - yv * wu) - p.y * (xu * wv - xv * wu);
}

// What rounding may leave of F where it ought to be 0: a small part of the product of lengths.
double roundingOf(const ViewPatch& p, double size) {
    constexpr double kRounding = 1e-13;
    const double w = p.w.largestMagnitude();
    double lengths[2] = {0, 0};
    for (const Bernstein2* axis : {&p.x, &p.y}) {
        lengths[0] = std::max(lengths[0], derivativeU(*axis).largestMagnitude());
        lengths[1] = std::max(lengths[1], derivativeV(*axis).largestMagnitude());
    }
    const double scale = p.w.c.size() == 1 ? 1 : w;
    // Places are differences of numbers as large as the page.
    const double least = 1e-9 * size * w;
    return kRounding * scale * std::max(lengths[0], least) * std::max(lengths[1], least);
}

// The image of a side that is one point does not fold anywhere; what folds beside it is told by F
// without that factor.
void removeFactors(ViewPatch& p, double size) {
    constexpr int kMostFactors = 4;
    const double rounding = roundingOf(p, size);
    p.hasFold = p.f.largestMagnitude() > rounding;
    for (int side = 0; side < 4 && p.hasFold; ++side) {
        for (int k = 0; k < kMostFactors; ++k) {
            const int degree = side < 2 ? p.f.m : p.f.n;
            const double least = std::max(rounding, 1e-12 * p.f.largestMagnitude());
            if (degree == 0 || sideMagnitude(p.f, side) > least) break;
            p.f = withoutFactor(p.f, side);
        }
    }
}

}  // namespace

std::array<double, 2> onSide(int side, double t) {
    if (side < 2) return {side == 0 ? 0.0 : 1.0, t};
    return {t, side == 2 ? 0.0 : 1.0};
}

ViewPatch seenBy(const ViewMatrix& view, const BezierPatch& patch, double size) {
    ViewPatch seen;
    seen.object = patch.object;
    std::array<Bernstein2*, 4> rows{&seen.x, &seen.y, &seen.z, &seen.w};
    for (std::size_t r = 0; r < 4; ++r) {
        *rows[r] = Bernstein2(patch.degreeU, patch.degreeV);
        for (std::size_t k = 0; k < patch.control.size(); ++k) {
            for (std::size_t c = 0; c < 4; ++c) rows[r]->c[k] += view[r][c] * patch.control[k][c];
        }
    }
    if (isConstant(seen.w)) {
        for (std::size_t r = 0; r < 3; ++r) {
            for (double& c : rows[r]->c) c /= seen.w.c[0];
        }
        seen.w = Bernstein2();
        seen.w.c[0] = 1;
    }
    seen.f = foldFunction(seen);
    removeFactors(seen, size);
    for (int side = 0; side < 4; ++side) {
        const auto [u0, v0] = onSide(side, 0);
        const ViewPoint a = seen.at(u0, v0);
        bool isPoint = true;
        for (int k = 1; k <= 8; ++k) {
            const auto [u, v] = onSide(side, k / 8.0);
            const ViewPoint b = seen.at(u, v);
            isPoint &= std::hypot(b.x - a.x, b.y - a.y, b.z - a.z) < 1e-9 * size;
        }
        seen.collapsed[static_cast<std::size_t>(side)] = isPoint;
    }
    return seen;
}

ViewPoint ViewPatch::at(double u, double v) const {
    const BernsteinBasis bu(x.m, u), bv(x.n, v);
    double value[4] = {0, 0, 0, 0}, du[4] = {0, 0, 0, 0}, dv[4] = {0, 0, 0, 0};
    const bool isRational = w.c.size() > 1;
    const double* rows[4] = {x.c.data(), y.c.data(), z.c.data(), w.c.data()};
    const int count = isRational ? 4 : 3;
    for (int i = 0, k = 0; i <= x.m; ++i) {
        for (int j = 0; j <= x.n; ++j, ++k) {
            const double b = bu.value(i) * bv.value(j);
            const double bdu = bu.slope(i) * bv.value(j);
            const double bdv = bu.value(i) * bv.slope(j);
            for (int r = 0; r < count; ++r) {
                value[r] += b * rows[r][k];
                du[r] += bdu * rows[r][k];
                dv[r] += bdv * rows[r][k];
            }
        }
    }
    if (!isRational) {
        return {value[0], value[1], value[2], du[0], du[1], du[2], dv[0], dv[1], dv[2]};
    }
    const double q = 1 / value[3];
    for (int r = 0; r < 3; ++r) {
        value[r] *= q;
        du[r] = (du[r] - du[3] * value[r]) * q;
        dv[r] = (dv[r] - dv[3] * value[r]) * q;
    }
    return {value[0], value[1], value[2], du[0], du[1], du[2], dv[0], dv[1], dv[2]};
}

std::array<double, 2> foldDirection(const ViewPoint& p) {
    const double along = std::hypot(p.xu, p.yu), across = std::hypot(p.xv, p.yv);
    const double length = std::max(along, across);
    if (!(length > 0)) return {1, 0};
    if (along >= across) return {p.xu / along, p.yu / along};
    return {p.xv / across, p.yv / across};
}

std::vector<ViewPatch> seenBy(const ViewMatrix& view, const std::vector<BezierPatch>& patches,
                              double size) {
    std::vector<ViewPatch> seen(patches.size());
    parallelFor(static_cast<std::int64_t>(seen.size()), [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        seen[k] = seenBy(view, patches[k], size);
    });
    return seen;
}

}  // namespace bandvox
