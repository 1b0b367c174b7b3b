#include "outline/patches/shared_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace bandvox {
namespace {

std::vector<std::array<double, 4>> sidePoints(const BezierPatch& patch, int side) {
    std::vector<std::array<double, 4>> points;
    const int last = side < 2 ? patch.degreeV : patch.degreeU;
    for (int k = 0; k <= last; ++k) {
        points.push_back(side < 2 ? patch.at(side == 0 ? 0 : patch.degreeU, k)
                                  : patch.at(k, side == 2 ? 0 : patch.degreeV));
    }
    return points;
}

bool isSameSide(const BezierPatch& a, int sideA, const BezierPatch& b, int sideB, bool reversed,
                double tolerance) {
    const auto p = sidePoints(a, sideA);
    auto q = sidePoints(b, sideB);
    if (p.size() != q.size()) return false;
    if (reversed) std::reverse(q.begin(), q.end());
    for (std::size_t k = 0; k < p.size(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            if (std::abs(p[k][c] / p[k][3] - q[k][c] / q[k][3]) > tolerance) return false;
        }
        if (std::abs(p[k][3] / p[0][3] - q[k][3] / q[0][3]) > 1e-6) return false;
    }
    return true;
}

double extentOf(std::span<const BezierPatch> patches) {
    std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const BezierPatch& patch : patches) {
        for (const auto& p : patch.control) {
            for (std::size_t c = 0; c < 3; ++c) {
                low[c] = std::min(low[c], p[c] / p[3]);
                high[c] = std::max(high[c], p[c] / p[3]);
            }
        }
    }
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

}  // namespace

std::vector<SharedSide> matchSides(std::span<const BezierPatch> patches,
                                   std::span<const ViewPatch> seen, const FaceRegions* faces) {
    const double tolerance = 1e-6 * extentOf(patches);
    // Sides that match have their middles in the same cell, or in one beside it.
    std::map<std::array<long long, 3>, std::vector<std::size_t>> cells;
    std::vector<SharedSide> shared;
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const FacePlace place = placeOf(faces, static_cast<int>(p));
        for (int side = 0; side < 4; ++side) {
            if (seen[p].collapsed[static_cast<std::size_t>(side)]) continue;
            if (place.face >= 0 && !place.inner[static_cast<std::size_t>(side)]) continue;
            const auto [u, v] = onSide(side, 0.5);
            const auto middle = evaluate(patches[p], u, v).position;
            std::array<long long, 3> cell{};
            for (std::size_t c = 0; c < 3; ++c) {
                cell[c] = std::llround(middle[c] / std::max(100 * tolerance, 1e-300));
            }
            const PatchSide mine{static_cast<int>(p), side};
            bool isNew = true;
            for (int near = 0; near < 27 && isNew; ++near) {
                const auto found = cells.find(
                    {cell[0] + near % 3 - 1, cell[1] + near / 3 % 3 - 1, cell[2] + near / 9 - 1});
                if (found == cells.end()) continue;
                for (const std::size_t k : found->second) {
                    SharedSide& other = shared[k];
                    if (placeOf(faces, other.a.patch).face != place.face) continue;
                    const BezierPatch& first = patches[static_cast<std::size_t>(other.a.patch)];
                    for (const bool reversed : {false, true}) {
                        if (!isNew || !isSameSide(first, other.a.side, patches[p], side, reversed,
                                                  tolerance)) {
                            continue;
                        }
                        isNew = false;
                        if (other.b) {
                            other.isCrowded = true;
                        } else {
                            other.b = mine;
                            other.reversed = reversed;
                        }
                    }
                }
            }
            if (!isNew) continue;
            cells[cell].push_back(shared.size());
            shared.push_back({mine, std::nullopt, false, false});
        }
    }
    return shared;
}

}  // namespace bandvox
