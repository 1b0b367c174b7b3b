#include "outline/sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {
namespace {

constexpr int kCells = 64;            // along a side of the page
constexpr int kDepthOfParts = 4;      // to which patches are cut in advance
constexpr double kSmallest = 1e-7;    // part of a patch that is cut no more
constexpr double kLargestBend = 0.4;  // of derivatives, relative to the mean

using Part = Sheets::Part;

// The part's control points on the page, and what they enclose.
void bound(Part& part) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    part.x0 = part.y0 = part.z0 = kInfinity;
    part.x1 = part.y1 = -kInfinity;
    const bool isRational = part.w.c.size() > 1;
    for (std::size_t k = 0; k < part.x.c.size(); ++k) {
        const double scale = isRational ? 1 / part.w.c[k] : 1;
        const double x = part.x.c[k] * scale, y = part.y.c[k] * scale, z = part.z.c[k] * scale;
        part.x0 = std::min(part.x0, x);
        part.x1 = std::max(part.x1, x);
        part.y0 = std::min(part.y0, y);
        part.y1 = std::max(part.y1, y);
        part.z0 = std::min(part.z0, z);
    }
}

// Whether the derivatives differ so little from their mean that no two places of the part are seen
// in the same place: the map's derivative, times the inverse of the mean, differs from 1 by less
// than 1 everywhere.
bool isOneToOne(const Part& part) {
    const bool isRational = part.w.c.size() > 1;
    const int m = part.x.m, n = part.x.n;
    const auto place = [&](int i, int j) {
        const double scale = isRational ? 1 / part.w.at(i, j) : 1;
        return std::array{part.x.at(i, j) * scale, part.y.at(i, j) * scale};
    };
    std::array<double, 2> meanU{}, meanV{};
    for (std::size_t c = 0; c < 2; ++c) {
        const double a = place(0, 0)[c], b = place(m, 0)[c], d = place(0, n)[c];
        const double e = place(m, n)[c];
        meanU[c] = 0.5 * (b - a + e - d);
        meanV[c] = 0.5 * (d - a + e - b);
    }
    const double area = meanU[0] * meanV[1] - meanU[1] * meanV[0];
    if (area == 0) return false;
    const auto isNear = [&](double dx, double dy, bool alongU) {
        const double u = (dx * meanV[1] - dy * meanV[0]) / area - (alongU ? 1 : 0);
        const double v = (dy * meanU[0] - dx * meanU[1]) / area - (alongU ? 0 : 1);
        return std::max(std::abs(u), std::abs(v)) < kLargestBend;
    };
    for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
            const auto p = place(i, j);
            if (i < m) {
                const auto q = place(i + 1, j);
                if (!isNear(m * (q[0] - p[0]), m * (q[1] - p[1]), true)) return false;
            }
            if (j < n) {
                const auto q = place(i, j + 1);
                if (!isNear(n * (q[0] - p[0]), n * (q[1] - p[1]), false)) return false;
            }
        }
    }
    return true;
}

// The halves of a part, along u or v, with their bounds.
std::array<Part, 2> halves(const Part& part, bool alongU) {
    const auto split = [alongU](const Bernstein2& p) { return alongU ? splitU(p) : splitV(p); };
    auto [x0, x1] = split(part.x);
    auto [y0, y1] = split(part.y);
    auto [z0, z1] = split(part.z);
    std::pair<Bernstein2, Bernstein2> w(part.w, part.w);
    if (part.w.c.size() > 1) w = split(part.w);
    std::array<Part, 2> result;
    result[0] = {.patch = part.patch,
                 .u0 = part.u0,
                 .v0 = part.v0,
                 .size = part.size,
                 .x = std::move(x0),
                 .y = std::move(y0),
                 .z = std::move(z0),
                 .w = std::move(w.first)};
    result[1] = {.patch = part.patch,
                 .u0 = part.u0,
                 .v0 = part.v0,
                 .size = part.size,
                 .x = std::move(x1),
                 .y = std::move(y1),
                 .z = std::move(z1),
                 .w = std::move(w.second)};
    (alongU ? result[1].u0 : result[1].v0) += 0.5 * part.size;
    for (Part& half : result) bound(half);
    return result;
}

// Calls visit with those quarters of a part that `isWanted` does not rule out by their bounds.
template <class IsWanted, class Visit>
void visitQuarters(const Part& part, const IsWanted& isWanted, const Visit& visit) {
    for (const Part& half : halves(part, true)) {
        if (!isWanted(half)) continue;
        for (Part& quarter : halves(half, false)) {
            if (!isWanted(quarter)) continue;
            quarter.size = 0.5 * part.size;
            quarter.oneToOne = isOneToOne(quarter);
            visit(std::move(quarter));
        }
    }
}

}  // namespace

Sheets::Sheets(std::span<const ViewPatch> patches) : mPatches(patches) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double right = -kInfinity, bottom = -kInfinity;
    mLeft = mTop = mNearest = kInfinity;
    mFarthest = -kInfinity;
    for (std::size_t k = 0; k < patches.size(); ++k) {
        const ViewPatch& patch = patches[k];
        Part part{.patch = static_cast<int>(k)};
        part.x = patch.x;
        part.y = patch.y;
        part.z = patch.z;
        part.w = patch.w;
        bound(part);
        part.oneToOne = isOneToOne(part);
        mLeft = std::min(mLeft, part.x0);
        right = std::max(right, part.x1);
        mTop = std::min(mTop, part.y0);
        bottom = std::max(bottom, part.y1);
        mNearest = std::min(mNearest, part.z0);
        for (std::size_t i = 0; i < part.z.c.size(); ++i) {
            const double w = part.w.c.size() > 1 ? part.w.c[i] : 1;
            mFarthest = std::max(mFarthest, part.z.c[i] / w);
        }
        if (patch.hasFold) addPart(std::move(part), 0);
    }
    mCellWidth = std::max((right - mLeft) / kCells, 1e-300);
    mCellHeight = std::max((bottom - mTop) / kCells, 1e-300);
    mCells.resize(std::size_t{kCells} * kCells);
    for (std::size_t k = 0; k < mParts.size(); ++k) {
        const Part& part = mParts[k];
        for (std::size_t j = row(part.y0); j <= row(part.y1); ++j) {
            for (std::size_t i = column(part.x0); i <= column(part.x1); ++i) {
                mCells[j * kCells + i].push_back(k);
            }
        }
    }
}

void Sheets::addPart(Part part, int depth) {
    // Large parts would be asked in vain too often.
    const bool isSmall = depth >= 2;
    if (depth == kDepthOfParts || (isSmall && part.oneToOne)) {
        mParts.push_back(std::move(part));
        return;
    }
    visitQuarters(
        part, [](const Part&) { return true; },
        [&](Part quarter) { addPart(std::move(quarter), depth + 1); });
}

std::size_t Sheets::column(double x) const {
    return static_cast<std::size_t>(
        std::clamp(std::floor((x - mLeft) / mCellWidth), 0.0, kCells - 1.0));
}

std::size_t Sheets::row(double y) const {
    return static_cast<std::size_t>(
        std::clamp(std::floor((y - mTop) / mCellHeight), 0.0, kCells - 1.0));
}

int Sheets::countIn(const Part& part, const std::array<double, 3>& target) const {
    const double x = target[0], y = target[1], z = target[2];
    const auto isAhead = [&](const Part& p) {
        return x >= p.x0 && x <= p.x1 && y >= p.y0 && y <= p.y1 && p.z0 < z;
    };
    if (!isAhead(part)) return 0;
    if (!part.oneToOne) {
        if (part.size < kSmallest) return 0;
        int count = 0;
        visitQuarters(part, isAhead,
                      [&](const Part& quarter) { count += countIn(quarter, target); });
        return count;
    }
    const ViewPatch& patch = mPatches[static_cast<std::size_t>(part.patch)];
    double u = part.u0 + 0.5 * part.size, v = part.v0 + 0.5 * part.size;
    ViewPoint p;
    for (int step = 0; step < 12; ++step) {
        p = patch.at(u, v);
        const double area = p.xu * p.yv - p.xv * p.yu;
        const double du = ((x - p.x) * p.yv - (y - p.y) * p.xv) / area;
        const double dv = ((y - p.y) * p.xu - (x - p.x) * p.yu) / area;
        u += du;
        v += dv;
        if (std::max(std::abs(du), std::abs(dv)) < 1e-10 * part.size) break;
        // Outside of the part the map may be anything.
        if (std::abs(u - part.u0 - 0.5 * part.size) > 2 * part.size ||
            std::abs(v - part.v0 - 0.5 * part.size) > 2 * part.size) {
            return 0;
        }
    }
    // Parts share their borders, and each has two of its own.
    const bool isInU =
        u >= part.u0 && (u < part.u0 + part.size || (u <= 1 && part.u0 + part.size == 1));
    const bool isInV =
        v >= part.v0 && (v < part.v0 + part.size || (v <= 1 && part.v0 + part.size == 1));
    return isInU && isInV && p.z < z ? 1 : 0;
}

int Sheets::countBefore(double x, double y, double z) const {
    int count = 0;
    for (const std::size_t k : mCells[row(y) * kCells + column(x)]) {
        count += countIn(mParts[k], {x, y, z});
    }
    return count;
}

}  // namespace bandvox
