#include "outline/patches/meeting_sides.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <utility>

namespace bandvox {
namespace {

using SharedCell = std::shared_ptr<const PatchCell>;

constexpr std::size_t kMostParts = 256;

// The control points of a side.
std::vector<Vec> sideRow(const PatchCell& cell, int side) {
    std::vector<Vec> row;
    const int last = side < 2 ? cell.n : cell.m;
    for (int k = 0; k <= last; ++k) {
        row.push_back(side < 2 ? cell.at(side == 0 ? 0 : cell.m, k)
                               : cell.at(k, side == 2 ? 0 : cell.n));
    }
    return row;
}

bool isApart(const std::vector<Vec>& row, const PatchCell& other) {
    for (std::size_t c = 0; c < 3; ++c) {
        const auto isBeyond = [&](const auto& beyond) {
            return std::all_of(row.begin(), row.end(), beyond);
        };
        if (isBeyond([&](const Vec& p) { return p[c] < other.low[c]; }) ||
            isBeyond([&](const Vec& p) { return p[c] > other.high[c]; })) {
            return true;
        }
    }
    if (!other.normals.isConvex()) return false;
    const auto spanOf = [&](const auto& points) {
        std::array<double, 2> span{1e300, -1e300};
        for (const Vec& p : points) {
            const double height = dot(p, other.normals.axis);
            span = {std::min(span[0], height), std::max(span[1], height)};
        }
        return span;
    };
    const auto a = spanOf(row), b = spanOf(other.points);
    return a[0] > b[1] || b[0] > a[1];
}

// Whether the side nowhere runs along the other cell's tangent planes, and so passes it once.
bool passesOnce(const PatchCell& cell, int side, const PatchCell& other) {
    const Cone& along = side < 2 ? cell.alongV : cell.alongU;
    return along.isConvex() && other.normals.isConvex() &&
           angleBetweenLines(along.axis, other.normals.axis) + along.halfAngle +
                   other.normals.halfAngle <
               0.5 * std::numbers::pi;
}

template <std::size_t kCount>
std::vector<SharedCell> partsOf(const PatchCell& cell,
                                const std::array<std::size_t, kCount>& which) {
    auto quarters = quartersOf(cell);
    std::vector<SharedCell> parts;
    for (const std::size_t q : which) {
        completeCell(quarters[q]);
        parts.push_back(std::make_shared<const PatchCell>(std::move(quarters[q])));
    }
    return parts;
}

}  // namespace

std::vector<SidePassage> sidePassages(const PatchCell& cell, int side, const PatchCell& other,
                                      double least) {
    static constexpr std::array<std::array<std::size_t, 2>, 4> kAtSide{
        {{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
    std::vector<SidePassage> passages;
    std::vector<std::pair<SharedCell, SharedCell>> pairs{
        {std::make_shared<const PatchCell>(cell), std::make_shared<const PatchCell>(other)}};
    while (!pairs.empty()) {
        const bool isLast = pairs.size() > kMostParts;
        const auto some = std::exchange(pairs, {});
        for (const auto& [a, b] : some) {
            if (isApart(sideRow(*a, side), *b)) continue;
            const bool isSmall = a->extent() < least && b->extent() < least;
            if (isLast || isSmall || passesOnce(*a, side, *b)) {
                passages.push_back({(side < 2 ? a->v0 : a->u0) + 0.5 * a->size,
                                    b->u0 + 0.5 * b->size, b->v0 + 0.5 * b->size, a->size,
                                    b->size});
                continue;
            }
            const auto partsB = partsOf<4>(*b, {0, 1, 2, 3});
            for (const SharedCell& p : partsOf(*a, kAtSide[static_cast<std::size_t>(side)])) {
                for (const SharedCell& q : partsB) pairs.emplace_back(p, q);
            }
        }
    }
    return passages;
}

}  // namespace bandvox
