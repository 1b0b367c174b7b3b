#include "outline/sheets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {
namespace {

constexpr int kCells = 64;           // along a side of the page
constexpr int kDepthOfParts = 4;     // to which patches are cut in advance
constexpr double kSmallest = 1e-7;   // part of a patch that is cut no more
constexpr double kLargestBend = 0.4; // of derivatives, relative to the mean

using Part = Sheets::Part;

// Bounds, and whether the derivatives differ so little from their mean that no two places of the
// part are seen in the same place: the map's derivative, times the inverse of the mean, differs
// from 1 by less than 1 everywhere.
void examine(Part& part) {
    const std::size_t count = part.x.c.size();
    const bool isRational = part.w.c.size() > 1;
    std::vector<std::array<double, 2>> places(count);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    part.x0 = part.y0 = part.z0 = kInfinity;
    part.x1 = part.y1 = -kInfinity;
    for (std::size_t k = 0; k < count; ++k) {
        const double w = isRational ? part.w.c[k] : 1;
        places[k] = {part.x.c[k] / w, part.y.c[k] / w};
        part.x0 = std::min(part.x0, places[k][0]);
        part.x1 = std::max(part.x1, places[k][0]);
        part.y0 = std::min(part.y0, places[k][1]);
        part.y1 = std::max(part.y1, places[k][1]);
        part.z0 = std::min(part.z0, part.z.c[k] / w);
    }
    const int m = part.x.m, n = part.x.n;
    const auto place = [&](int i, int j) { return places[static_cast<std::size_t>(i * (n + 1) + j)]; };
    std::array<double, 2> meanU{}, meanV{};
    for (std::size_t c = 0; c < 2; ++c) {
        meanU[c] = 0.5 * (place(m, 0)[c] - place(0, 0)[c] + place(m, n)[c] - place(0, n)[c]);
        meanV[c] = 0.5 * (place(0, n)[c] - place(0, 0)[c] + place(m, n)[c] - place(m, 0)[c]);
    }
    const double area = meanU[0] * meanV[1] - meanU[1] * meanV[0];
    part.oneToOne = area != 0;
    const auto bend = [&](double dx, double dy, bool alongU) {
        const double u = (dx * meanV[1] - dy * meanV[0]) / area - (alongU ? 1 : 0);
        const double v = (dy * meanU[0] - dx * meanU[1]) / area - (alongU ? 0 : 1);
        return std::max(std::abs(u), std::abs(v));
    };
    for (int i = 0; i <= m && part.oneToOne; ++i) {
        for (int j = 0; j <= n && part.oneToOne; ++j) {
            const auto p = place(i, j);
            if (i < m) {
                const auto q = place(i + 1, j);
                part.oneToOne &= bend(m * (q[0] - p[0]), m * (q[1] - p[1]), true) < kLargestBend;
            }
            if (j < n) {
                const auto q = place(i, j + 1);
                part.oneToOne &= bend(n * (q[0] - p[0]), n * (q[1] - p[1]), false) < kLargestBend;
            }
        }
    }
}

std::array<Part, 4> cut(const Part& part) {
    auto x = quarters(part.x), y = quarters(part.y), z = quarters(part.z);
    std::array<Bernstein2, 4> w{part.w, part.w, part.w, part.w};
    if (part.w.c.size() > 1) w = quarters(part.w);
    std::array<Part, 4> parts;
    const double half = 0.5 * part.size;
    for (std::size_t q = 0; q < 4; ++q) {
        parts[q] = {.patch = part.patch,
                    .u0 = part.u0 + (q >= 2 ? half : 0),
                    .v0 = part.v0 + (q % 2 ? half : 0),
                    .size = half,
                    .x = std::move(x[q]),
                    .y = std::move(y[q]),
                    .z = std::move(z[q]),
                    .w = std::move(w[q])};
        examine(parts[q]);
    }
    return parts;
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
        examine(part);
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
    for (Part& quarter : cut(part)) addPart(std::move(quarter), depth + 1);
}

std::size_t Sheets::column(double x) const {
    return static_cast<std::size_t>(std::clamp(std::floor((x - mLeft) / mCellWidth), 0.0, kCells - 1.0));
}

std::size_t Sheets::row(double y) const {
    return static_cast<std::size_t>(std::clamp(std::floor((y - mTop) / mCellHeight), 0.0, kCells - 1.0));
}

int Sheets::countIn(const Part& part, const std::array<double, 3>& target) const {
    const auto [x, y, z] = target;
    if (x < part.x0 || x > part.x1 || y < part.y0 || y > part.y1 || part.z0 >= z) return 0;
    if (!part.oneToOne) {
        if (part.size < kSmallest) return 0;
        int count = 0;
        for (const Part& quarter : cut(part)) count += countIn(quarter, target);
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
    const bool isInU = u >= part.u0 && (u < part.u0 + part.size || (u <= 1 && part.u0 + part.size == 1));
    const bool isInV = v >= part.v0 && (v < part.v0 + part.size || (v <= 1 && part.v0 + part.size == 1));
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
