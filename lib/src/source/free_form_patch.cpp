#include "source/free_form_patch.h"

#include "source/bernstein_basis.h"

#include <bandvox/source/quadrature.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

static_assert(BezierPatch::kHighestDegree <= BernsteinBasis::kMost);

/// Halvings after which integrals are taken as they are.
constexpr int kDeepestIntegral = 12;

/// Halvings after which a cell's box is taken as it is.
constexpr int kDeepestBox = 40;

std::array<ParameterCell, 4> quarters(const ParameterCell& c) {
    const double u = 0.5 * (c.u0 + c.u1);
    const double v = 0.5 * (c.v0 + c.v1);
    return {{{c.u0, u, c.v0, v}, {u, c.u1, c.v0, v}, {c.u0, u, v, c.v1}, {u, c.u1, v, c.v1}}};
}

PatchIntegrals byRule(const Patch& patch, const Vec3d& center, const ParameterCell& cell) {
    constexpr int kRule = 5;
    const double du = cell.u1 - cell.u0;
    const double dv = cell.v1 - cell.v0;
    PatchIntegrals sum;
    for (const IntervalPoint& u : intervalRule(kRule)) {
        for (const IntervalPoint& v : intervalRule(kRule)) {
            const PatchPoint p = patch.at(cell.u0 + u.position * du, cell.v0 + v.position * dv);
            const Vec3d normal = (u.weight * v.weight * du * dv) * p.du.cross(p.dv);
            sum.area += normal.length();
            sum.flux += (p.position - center).dot(normal);
        }
    }
    return sum;
}

// What is still wanted of an integral.
struct IntegralGoal {
    const Patch& patch;
    Vec3d center;
    double flux, area;  // differences that are allowed
};

PatchIntegrals refine(const IntegralGoal& goal, const ParameterCell& cell,
                      const PatchIntegrals& coarse, int depth) {
    std::array<PatchIntegrals, 4> parts;
    PatchIntegrals sum;
    const auto cells = quarters(cell);
    for (std::size_t k = 0; k < 4; ++k) {
        parts[k] = byRule(goal.patch, goal.center, cells[k]);
        sum.area += parts[k].area;
        sum.flux += parts[k].flux;
    }
    const bool agrees = std::abs(sum.flux - coarse.flux) <= goal.flux &&
                        std::abs(sum.area - coarse.area) <= goal.area;
    if (agrees || depth == kDeepestIntegral) return sum;
    sum = {};
    for (std::size_t k = 0; k < 4; ++k) {
        const PatchIntegrals part = refine(goal, cells[k], parts[k], depth + 1);
        sum.area += part.area;
        sum.flux += part.flux;
    }
    return sum;
}

}  // namespace

FreeFormPatch::FreeFormPatch(BezierPatch patch)
    : mPatch(std::move(patch)), mLeastWeight(std::numeric_limits<double>::max()) {
    for (const Homogeneous& p : mPatch.control) {
        mHull.expand(Vec3d(p[0], p[1], p[2]) / p[3]);
        mLeastWeight = std::min(mLeastWeight, p[3]);
    }
    const int n = mPatch.degreeU;
    const int m = mPatch.degreeV;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            for (std::size_t c = 0; c < 4; ++c) {
                const double middle = 2 * mPatch.at(i, j)[c];
                if (i > 0 && i < n) {
                    const double bend = mPatch.at(i - 1, j)[c] - middle + mPatch.at(i + 1, j)[c];
                    mBendU[c] = std::max(mBendU[c], n * (n - 1) * std::abs(bend));
                }
                if (j > 0 && j < m) {
                    const double bend = mPatch.at(i, j - 1)[c] - middle + mPatch.at(i, j + 1)[c];
                    mBendV[c] = std::max(mBendV[c], m * (m - 1) * std::abs(bend));
                }
            }
        }
    }
}

FreeFormPatch::Homogeneous FreeFormPatch::homogeneousAt(double u, double v) const {
    const BernsteinBasis a(mPatch.degreeU, u);
    const BernsteinBasis b(mPatch.degreeV, v);
    Homogeneous sum{};
    std::size_t k = 0;
    for (int i = 0; i <= mPatch.degreeU; ++i) {
        for (int j = 0; j <= mPatch.degreeV; ++j, ++k) {
            const double weight = a.value(i) * b.value(j);
            for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * mPatch.control[k][c];
        }
    }
    return sum;
}

PatchPoint FreeFormPatch::at(double u, double v) const {
    const BernsteinBasis a(mPatch.degreeU, u);
    const BernsteinBasis b(mPatch.degreeV, v);
    Homogeneous s{}, su{}, sv{};
    std::size_t k = 0;
    for (int i = 0; i <= mPatch.degreeU; ++i) {
        Homogeneous row{}, slope{};
        for (int j = 0; j <= mPatch.degreeV; ++j, ++k) {
            const double value = b.value(j), rise = b.slope(j);
            for (std::size_t c = 0; c < 4; ++c) {
                row[c] += value * mPatch.control[k][c];
                slope[c] += rise * mPatch.control[k][c];
            }
        }
        const double value = a.value(i), rise = a.slope(i);
        for (std::size_t c = 0; c < 4; ++c) {
            s[c] += value * row[c];
            su[c] += rise * row[c];
            sv[c] += value * slope[c];
        }
    }
    PatchPoint p;
    for (int c = 0; c < 3; ++c) {
        const auto k3 = static_cast<std::size_t>(c);
        p.position[c] = s[k3] / s[3];
        p.du[c] = (su[k3] - su[3] * p.position[c]) / s[3];
        p.dv[c] = (sv[k3] - sv[3] * p.position[c]) / s[3];
    }
    return p;
}

openvdb::BBoxd FreeFormPatch::bounds(const ParameterCell& cell) const {
    const Homogeneous corners[4] = {
        homogeneousAt(cell.u0, cell.v0), homogeneousAt(cell.u0, cell.v1),
        homogeneousAt(cell.u1, cell.v0), homogeneousAt(cell.u1, cell.v1)};
    const double du = cell.u1 - cell.u0;
    const double dv = cell.v1 - cell.v0;
    // Linear interpolation is off by an eighth of the second derivative times the step squared.
    Homogeneous off{};
    double least = corners[0][3];
    for (std::size_t c = 0; c < 4; ++c) {
        off[c] = (du * du * mBendU[c] + dv * dv * mBendV[c]) / 8;
        least = std::min(least, corners[c][3]);
    }
    least = std::max(least - off[3], mLeastWeight);
    openvdb::BBoxd box;
    for (const Homogeneous& p : corners) box.expand(Vec3d(p[0], p[1], p[2]) / p[3]);
    for (int axis = 0; axis < 3; ++axis) {
        const auto c = static_cast<std::size_t>(axis);
        // Relative to x the numerator w (x' - x) is at most what it is off, and so x' - x.
        const double farthest = std::max(std::abs(box.min()[axis]), std::abs(box.max()[axis]));
        const double margin = (off[c] + farthest * off[3]) / least;
        box.min()[axis] = std::max(box.min()[axis] - margin, mHull.min()[axis]);
        box.max()[axis] = std::min(box.max()[axis] + margin, mHull.max()[axis]);
    }
    return box;
}

openvdb::BBoxd tightBounds(const std::vector<FreeFormPatch>& patches, double tolerance) {
    openvdb::BBoxd known;
    for (const FreeFormPatch& patch : patches) {
        for (const double u : {0.0, 0.5, 1.0}) {
            for (const double v : {0.0, 0.5, 1.0}) known.expand(patch.at(u, v).position);
        }
    }
    const auto isWithin = [&](const openvdb::BBoxd& box) {
        for (int axis = 0; axis < 3; ++axis) {
            if (box.min()[axis] < known.min()[axis] - tolerance) return false;
            if (box.max()[axis] > known.max()[axis] + tolerance) return false;
        }
        return true;
    };
    openvdb::BBoxd rest;
    for (const FreeFormPatch& patch : patches) {
        std::vector<std::pair<ParameterCell, int>> pending{{{}, 0}};
        while (!pending.empty()) {
            const auto [cell, depth] = pending.back();
            pending.pop_back();
            const openvdb::BBoxd box = patch.bounds(cell);
            if (isWithin(box)) continue;
            if (depth == kDeepestBox) {
                rest.expand(box);
                continue;
            }
            known.expand(patch.at(0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1)).position);
            for (const ParameterCell& part : quarters(cell)) pending.emplace_back(part, depth + 1);
        }
    }
    known.expand(rest);
    return known;
}

PatchIntegrals integrate(const Patch& patch, const Vec3d& center, double size) {
    constexpr double kFlux = 1e-12;
    constexpr double kArea = 1e-8;
    const PatchIntegrals coarse = byRule(patch, center, {});
    return refine({patch, center, kFlux * coarse.area * size, kArea * coarse.area}, {}, coarse, 0);
}

}  // namespace bandvox
