#include "source/unfolded_stars.h"

#include "source/certain_turn.h"
#include "source/index_blocks.h"
#include "source/point_lists.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;

/// A triangle as seen from one of its corners: the other two, in its own direction.
struct Sector {
    std::uint32_t from, to;
};

/// Puts sectors in the order in which one follows the other. False if they do not make one closed
/// turn, or so many that it is not worth while.
bool orderAround(std::span<Sector> sectors) {
    for (std::size_t i = 0; i + 1 < sectors.size(); ++i) {
        std::size_t next = i + 1;
        while (next < sectors.size() && sectors[next].from != sectors[i].to) ++next;
        if (next == sectors.size()) return false;
        std::swap(sectors[i + 1], sectors[next]);
    }
    return sectors.back().to == sectors.front().from;
}

/// True if a direction lies in the half-open upper half of a view, from u to before -u.
bool isUpper(const Vec3d& direction, const Vec3d& origin, View2 view) {
    if (direction[view.v] != origin[view.v]) return direction[view.v] > origin[view.v];
    return direction[view.u] > origin[view.u];
}

/// How often triangles around a point go around it in a view, in which all turn the same way.
int turnsAround(const Mesh& mesh, const Vec3d& origin, std::span<const Sector> sectors, View2 view,
                bool turnLeft) {
    // Each spans less than half a turn, so it passes u if it leads from the lower half to the
    // upper, the way around that it turns.
    int turns = 0;
    for (const Sector& sector : sectors) {
        const bool from = isUpper(mesh.points[sector.from], origin, view);
        const bool to = isUpper(mesh.points[sector.to], origin, view);
        turns += (turnLeft ? !from && to : from && !to) ? 1 : 0;
    }
    return turns;
}

bool isUnfolded(const Mesh& mesh, std::uint32_t point, std::span<const std::uint32_t> corners,
                const std::vector<std::uint8_t>& facings, std::vector<Sector>& sectors) {
    // Beyond that, putting them in order takes longer than looking at their pairs.
    constexpr std::size_t kLeast = 3, kMost = 64;
    if (corners.size() < kLeast || corners.size() > kMost) return false;
    unsigned common = 0x3f;
    for (const std::uint32_t corner : corners) common &= facings[corner / 3];
    if (common == 0) return false;
    sectors.clear();
    for (const std::uint32_t corner : corners) {
        const Vec3I& t = mesh.triangles[corner / 3];
        sectors.push_back({t[(corner + 1) % 3], t[(corner + 2) % 3]});
    }
    if (!orderAround(sectors)) return false;
    for (int bit = 0; bit < 6; ++bit) {
        if ((common >> bit & 1) == 0) continue;
        if (turnsAround(mesh, mesh.points[point], sectors, viewAlong(bit / 2), bit % 2 == 0) == 1) {
            return true;
        }
    }
    return false;
}

}  // namespace

std::vector<std::uint8_t> certainFacings(const Mesh& mesh) {
    std::vector<std::uint8_t> facings(mesh.triangles.size());
    forEachIndex(facings.size(), [&](std::size_t i) {
        const Vec3I& t = mesh.triangles[i];
        unsigned bits = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int turn = certainTurn(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]],
                                         viewAlong(axis));
            if (turn != 0) bits |= (turn > 0 ? 1U : 2U) << (2 * axis);
        }
        facings[i] = static_cast<std::uint8_t>(bits);
    });
    return facings;
}

std::vector<std::uint8_t> findUnfoldedStars(const Mesh& mesh,
                                            const std::vector<std::uint8_t>& facings) {
    const PointLists corners =
        listByPoint<3>(mesh.triangles, mesh.points.size(),
                       [](const Vec3I& triangle, int k) { return triangle[k]; });
    std::vector<std::uint8_t> unfolded(mesh.points.size());
    forEachIndexBlock(unfolded.size(), [&](std::size_t begin, std::size_t end) {
        std::vector<Sector> sectors;
        for (std::size_t p = begin; p < end; ++p) {
            const auto point = static_cast<std::uint32_t>(p);
            unfolded[p] = isUnfolded(mesh, point, corners.of(p), facings, sectors) ? 1 : 0;
        }
    });
    return unfolded;
}

}  // namespace bandvox
