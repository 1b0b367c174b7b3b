#include "outline/patches/sheets.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace bandvox {
namespace {

constexpr int kDepthOfParts = 4;  // to which patches are cut in advance
// Of a patch, that is cut no more: it moves a fold by the square of that.
constexpr double kSmallest = 1.0 / 131072;
// Beside a fold few parts are as small as this. But all along a side that is a point each of them
// holds it: then they are not worth to be cut further.
constexpr double kSmall = 1.0 / 8192;
constexpr int kMostSmallCuts = 256;
constexpr double kLargestBend = 0.4;  // of derivatives, relative to the mean
constexpr double kBeside = 1e-10;     // parameters that differ by rounding

using Part = Sheets::Part;

// The part's control points on the page, and what they enclose.
void bound(Part& part) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    part.x0 = part.y0 = part.z0 = kInfinity;
    part.x1 = part.y1 = -kInfinity;
    for (std::size_t k = 0; k < part.homogeneous.size(); ++k) {
        const auto& h = part.homogeneous[k];
        const double scale = 1 / h[3];
        part.points[k] = {h[0] * scale, h[1] * scale, h[2] * scale};
    }
    for (const auto& p : part.points) {
        part.x0 = std::min(part.x0, p[0]);
        part.x1 = std::max(part.x1, p[0]);
        part.y0 = std::min(part.y0, p[1]);
        part.y1 = std::max(part.y1, p[1]);
        part.z0 = std::min(part.z0, p[2]);
    }
}

// Finds out whether derivatives differ so little from their mean that no two places of the part are
// seen in the same place: the map's derivative, times the inverse of the mean, differs from 1 by
// less than 1 everywhere.
void judge(Part& part, const ViewPatch& patch) {
    const auto row = static_cast<std::size_t>(part.n) + 1;
    const auto last = part.points.size() - 1;
    const auto &a = part.points[0], &b = part.points[last - row + 1];
    const auto &d = part.points[row - 1], &e = part.points[last];
    std::array<double, 2> meanU{}, meanV{};
    for (std::size_t c = 0; c < 2; ++c) {
        meanU[c] = 0.5 * (b[c] - a[c] + e[c] - d[c]);
        meanV[c] = 0.5 * (d[c] - a[c] + e[c] - b[c]);
    }
    part.oneToOne = false;
    const double area = meanU[0] * meanV[1] - meanU[1] * meanV[0];
    if (area == 0) return;
    const std::array<double, 4> inverse{meanV[1] / area, -meanV[0] / area, -meanU[1] / area,
                                        meanU[0] / area};
    double bend = 0;
    const auto compare = [&](const auto& p, const auto& q, int degree, bool alongU) {
        const double dx = degree * (q[0] - p[0]), dy = degree * (q[1] - p[1]);
        const double u = dx * inverse[0] + dy * inverse[1] - (alongU ? 1 : 0);
        const double v = dx * inverse[2] + dy * inverse[3] - (alongU ? 0 : 1);
        bend = std::max({bend, std::abs(u), std::abs(v)});
    };
    std::size_t k = 0;
    for (int i = 0; i <= part.m; ++i) {
        for (int j = 0; j <= part.n; ++j, ++k) {
            if (i < part.m) compare(part.points[k], part.points[k + row], part.m, true);
            if (j < part.n) compare(part.points[k], part.points[k + 1], part.n, false);
        }
        if (!(bend < kLargestBend)) return;
    }
    part.oneToOne = true;
    part.bend = bend;
    for (std::size_t c = 0; c < 4; ++c) part.inverse[c] = part.size * inverse[c];
    const ViewPoint middle = patch.at(part.u0 + 0.5 * part.size, part.v0 + 0.5 * part.size);
    part.middleX = middle.x;
    part.middleY = middle.y;
}

// Makes a part its half of low u, or v; returns the other one.
Part halvePart(Part& part, bool alongU) {
    Part high{.patch = part.patch,
              .m = part.m,
              .n = part.n,
              .u0 = part.u0,
              .v0 = part.v0,
              .size = part.size};
    if (part.homogeneous.empty()) {
        high.points = halveNet(part.points, part.m, part.n, alongU);
    } else {
        high.homogeneous = halveNet(part.homogeneous, part.m, part.n, alongU);
        high.points.resize(high.homogeneous.size());
    }
    (alongU ? high.u0 : high.v0) += 0.5 * part.size;
    bound(part);
    bound(high);
    return high;
}

// Calls visit with those quarters of a part that `isWanted` does not rule out by their bounds.
template <class IsWanted, class Visit>
void visitQuarters(const Part& part, const ViewPatch& patch, const IsWanted& isWanted,
                   const Visit& visit) {
    Part low = part;
    Part high = halvePart(low, true);
    for (Part* half : {&low, &high}) {
        if (!isWanted(*half)) continue;
        Part other = halvePart(*half, false);
        for (Part* quarter : {half, &other}) {
            if (!isWanted(*quarter)) continue;
            quarter->size = 0.5 * part.size;
            judge(*quarter, patch);
            visit(std::move(*quarter));
        }
    }
}

}  // namespace

/// A line of sight, and what it has met.
struct Sheets::Sight {
    double x, y, z;  // what is farther does not count
    double sameDepth = 0;
    std::vector<Place> met{};
    int smallCuts = 0;

    // Parts reach beyond their borders by rounding: a place on a border of parts, or of patches,
    // is found more than once, and counts once.
    void add(const Place& place) {
        const bool isKnown = std::any_of(met.begin(), met.end(), [&](const Place& other) {
            if (std::abs(other.z - place.z) > sameDepth) return false;
            if (other.patch != place.patch) return isOnBorder(other) && isOnBorder(place);
            constexpr double kSamePlace = 1e-6;
            return std::abs(other.u - place.u) + std::abs(other.v - place.v) < kSamePlace;
        });
        if (!isKnown) met.push_back(place);
    }

    static bool isOnBorder(const Place& p) {
        const auto isEnd = [](double t) { return t <= kBeside || t >= 1 - kBeside; };
        return isEnd(p.u) || isEnd(p.v);
    }

    bool mayMeet(const Part& p) const {
        return x >= p.x0 && x <= p.x1 && y >= p.y0 && y <= p.y1 && p.z0 < z;
    }
};

Sheets::Sheets(std::span<const ViewPatch> patches, const FaceRegions* faces)
    : mPatches(patches), mFaces(faces) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double right = -kInfinity, bottom = -kInfinity;
    mLeft = mTop = kInfinity;
    std::vector<Part> wholes;
    for (std::size_t k = 0; k < patches.size(); ++k) {
        const ViewPatch& patch = patches[k];
        if (!patch.hasFold) continue;
        Part part{.patch = static_cast<int>(k), .m = patch.x.m, .n = patch.x.n};
        part.points.resize(patch.x.c.size());
        const bool isRational = patch.w.c.size() > 1;
        if (isRational) part.homogeneous.resize(patch.x.c.size());
        for (std::size_t i = 0; i < part.points.size(); ++i) {
            part.points[i] = {patch.x.c[i], patch.y.c[i], patch.z.c[i]};
            if (isRational) {
                part.homogeneous[i] = {patch.x.c[i], patch.y.c[i], patch.z.c[i], patch.w.c[i]};
            }
        }
        bound(part);
        mLeft = std::min(mLeft, part.x0);
        right = std::max(right, part.x1);
        mTop = std::min(mTop, part.y0);
        bottom = std::max(bottom, part.y1);
        wholes.push_back(std::move(part));
    }
    std::vector<std::vector<Part>> parts(wholes.size());
    parallelFor(static_cast<std::int64_t>(wholes.size()), [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        cutPart(std::move(wholes[k]), 0, parts[k]);
    });
    for (auto& some : parts) std::move(some.begin(), some.end(), std::back_inserter(mParts));
    mCellWidth = std::max((right - mLeft) / kCells, 1e-300);
    mCellHeight = std::max((bottom - mTop) / kCells, 1e-300);
    mCells.resize(std::size_t{kCells} * kCells);
    for (std::size_t k = 0; k < mParts.size(); ++k) {
        const Part& part = mParts[k];
        for (std::size_t j = row(part.y0); j <= row(part.y1); ++j) {
            for (std::size_t i = column(part.x0); i <= column(part.x1); ++i) {
                mCells[j * kCells + i].push_back(static_cast<std::uint32_t>(k));
            }
        }
    }
}

void Sheets::cutPart(Part part, int depth, std::vector<Part>& parts) const {
    // Large parts would be asked in vain too often.
    const bool isSmall = depth >= 2;
    if (depth == kDepthOfParts || (isSmall && part.oneToOne)) {
        if (mFaces && mFaces->isTrimmed(part.patch)) {
            const double u = part.u0, v = part.v0, size = part.size;
            const ParameterBox box{{u - kBeside, v - kBeside},
                                   {u + size + kBeside, v + size + kBeside}};
            const bool isCut = mFaces->mayCut(part.patch, box);
            if (!isCut && !mFaces->keeps(part.patch, u + 0.5 * size, v + 0.5 * size)) return;
        }
        parts.push_back(std::move(part));
        return;
    }
    visitQuarters(
        part, mPatches[static_cast<std::size_t>(part.patch)], [](const Part&) { return true; },
        [&](Part quarter) { cutPart(std::move(quarter), depth + 1, parts); });
}

std::size_t Sheets::column(double x) const {
    return static_cast<std::size_t>(
        std::clamp(std::floor((x - mLeft) / mCellWidth), 0.0, kCells - 1.0));
}

std::size_t Sheets::row(double y) const {
    return static_cast<std::size_t>(
        std::clamp(std::floor((y - mTop) / mCellHeight), 0.0, kCells - 1.0));
}

void Sheets::meetCut(const Part& part, Sight& sight) const {
    if (part.size < kSmallest) return;
    if (part.size <= kSmall && ++sight.smallCuts > kMostSmallCuts) return;
    visitQuarters(
        part, mPatches[static_cast<std::size_t>(part.patch)],
        [&](const Part& p) { return sight.mayMeet(p); },
        [&](const Part& quarter) { meet(quarter, sight); });
}

void Sheets::meet(const Part& part, Sight& sight) const {
    if (!part.oneToOne) return meetCut(part, sight);
    // By the bound of derivatives a place is not farther from the one that the mean derivative
    // tells than `bend` of the way.
    const double half = 0.5 * part.size;
    const double gx = sight.x - part.middleX, gy = sight.y - part.middleY;
    const double du0 = gx * part.inverse[0] + gy * part.inverse[1];
    const double dv0 = gx * part.inverse[2] + gy * part.inverse[3];
    if (std::max(std::abs(du0), std::abs(dv0)) > half * (1 + 2 * part.bend)) return;
    const ViewPatch& patch = mPatches[static_cast<std::size_t>(part.patch)];
    double u = part.u0 + half + du0, v = part.v0 + half + dv0;
    ViewPoint p;
    bool isFound = false;
    for (int step = 0; step < 12 && !isFound; ++step) {
        p = patch.at(u, v);
        const double area = p.xu * p.yv - p.xv * p.yu;
        const double du = ((sight.x - p.x) * p.yv - (sight.y - p.y) * p.xv) / area;
        const double dv = ((sight.y - p.y) * p.xu - (sight.x - p.x) * p.yu) / area;
        u += du;
        v += dv;
        isFound = std::max(std::abs(du), std::abs(dv)) < 1e-7 * part.size;
        if (isFound) p.z += p.zu * du + p.zv * dv;
        // Outside of the part the map may be anything.
        if (!(std::abs(u - part.u0 - half) < 2 * half && std::abs(v - part.v0 - half) < 2 * half)) {
            break;
        }
    }
    if (!isFound) return meetCut(part, sight);
    const auto isIn = [&](double t, double from) {
        return t >= from - kBeside && t <= from + part.size + kBeside;
    };
    if (!isIn(u, part.u0) || !isIn(v, part.v0) || !(p.z < sight.z)) return;
    if (mFaces && !mFaces->keeps(part.patch, u, v)) return;
    sight.add({part.patch, std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0), p.z});
}

void Sheets::meetAll(Sight& sight) const {
    for (const std::uint32_t k : mCells[row(sight.y) * kCells + column(sight.x)]) {
        if (sight.mayMeet(mParts[k])) meet(mParts[k], sight);
    }
}

int Sheets::countBefore(const CurvePoint& point, double margin) const {
    Sight sight{point.x, point.y, point.z - margin, sameDepth()};
    meetAll(sight);
    return static_cast<int>(sight.met.size());
}

int Sheets::countBefore(const CurvePoint& point, double margin, std::span<const int> ownFaces,
                        double ownMargin) const {
    Sight sight{point.x, point.y, point.z - margin, sameDepth()};
    meetAll(sight);
    return static_cast<int>(
        std::count_if(sight.met.begin(), sight.met.end(), [&](const Place& place) {
            const int face = placeOf(mFaces, place.patch).face;
            const bool isOwn = std::find(ownFaces.begin(), ownFaces.end(), face) != ownFaces.end();
            return !isOwn || place.z < point.z - ownMargin;
        }));
}

std::optional<Sheets::Place> Sheets::firstAt(double x, double y) const {
    Sight sight{x, y, std::numeric_limits<double>::infinity(), sameDepth()};
    meetAll(sight);
    if (sight.met.empty()) return std::nullopt;
    const auto nearest = std::min_element(sight.met.begin(), sight.met.end(),
                                          [](const Place& a, const Place& b) { return a.z < b.z; });
    // Of surfaces in the same place rounding does not choose.
    const double limit = nearest->z + sameDepth();
    const auto objectOf = [&](const Place& place) {
        return mPatches[static_cast<std::size_t>(place.patch)].object;
    };
    Place first = *nearest;
    for (const Place& place : sight.met) {
        if (place.z <= limit && objectOf(place) < objectOf(first)) first = place;
    }
    return first;
}

}  // namespace bandvox
