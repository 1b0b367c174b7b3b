#include "source/remove_duplicates.h"

#include "source/index_blocks.h"
#include "source/point_lists.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {
namespace {

/// A triangle's corners in rising order, and whether it runs through them in that order.
struct SortedTriangle {
    std::array<std::uint32_t, 3> corner;
    bool rises;
    std::uint32_t index;
};

SortedTriangle sorted(const openvdb::Vec3I& t, std::uint32_t index) {
    SortedTriangle s{{t[0], t[1], t[2]}, true, index};
    // Each exchange reverses the direction.
    const auto exchange = [&s](int a, int b) {
        if (s.corner[a] <= s.corner[b]) return;
        std::swap(s.corner[a], s.corner[b]);
        s.rises = !s.rises;
    };
    exchange(0, 1);
    exchange(1, 2);
    exchange(0, 1);
    return s;
}

/// Triangles that have equal corners, side by side, in the order of the mesh.
std::vector<SortedTriangle> groupTriangles(const Mesh& mesh) {
    // Collect them by their lowest corner, then sort the few of each point.
    std::vector<SortedTriangle> list(mesh.triangles.size());
    std::vector<std::size_t> start(mesh.points.size() + 1, 0);
    const auto lowest = [](const openvdb::Vec3I& t) { return std::min({t[0], t[1], t[2]}); };
    for (const openvdb::Vec3I& t : mesh.triangles) ++start[lowest(t) + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    std::vector<std::size_t> cursor = start;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        list[cursor[lowest(mesh.triangles[i])]++] = sorted(mesh.triangles[i], i);
    }
    for (std::size_t i = 0; i + 1 < start.size(); ++i) {
        std::sort(list.begin() + static_cast<std::ptrdiff_t>(start[i]),
                  list.begin() + static_cast<std::ptrdiff_t>(start[i + 1]),
                  [](const SortedTriangle& a, const SortedTriangle& b) {
                      return a.corner != b.corner ? a.corner < b.corner : a.index < b.index;
                  });
    }
    return list;
}

/// True if any two of these triangles have equal corners.
bool haveEqual(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    std::vector<std::array<std::uint32_t, 3>> corners;
    corners.reserve(triangles.size());
    for (const std::uint32_t t : triangles) corners.push_back(sorted(mesh.triangles[t], t).corner);
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
}

/// True if any two triangles have equal corners.
bool haveDuplicates(const Mesh& mesh) {
    const PointLists lists =
        listByPoint<1>(mesh.triangles, mesh.points.size(), [](const openvdb::Vec3I& t, int) {
            return std::min({t[0], t[1], t[2]});
        });
    return countIndices(mesh.points.size(), [&](std::size_t point) {
               const std::span<const std::uint32_t> list = lists.of(point);
               // A point may be the lowest corner of many, as the middle of a fan.
               constexpr std::size_t kFew = 32;
               if (list.size() > kFew) return haveEqual(mesh, list);
               for (std::size_t i = 0; i < list.size(); ++i) {
                   const auto corner = sorted(mesh.triangles[list[i]], list[i]).corner;
                   for (std::size_t k = 0; k < i; ++k) {
                       if (sorted(mesh.triangles[list[k]], list[k]).corner == corner) return true;
                   }
               }
               return false;
           }) > 0;
}

}  // namespace

std::size_t removeDuplicates(Mesh& mesh) {
    if (!haveDuplicates(mesh)) return 0;
    const std::vector<SortedTriangle> list = groupTriangles(mesh);

    // Find the groups, and how many triangles have another that faces the opposite way.
    struct Group {
        std::size_t begin, end;
        std::size_t rising;
    };
    std::vector<Group> groups;
    std::size_t opposed = 0;
    for (std::size_t begin = 0; begin < list.size();) {
        std::size_t end = begin;
        std::size_t rising = 0;
        for (; end < list.size() && list[end].corner == list[begin].corner; ++end) {
            rising += list[end].rises ? 1 : 0;
        }
        if (end - begin > 1) groups.push_back({begin, end, rising});
        if (rising > 0 && rising < end - begin) opposed += end - begin;
        begin = end;
    }
    if (groups.empty()) return 0;

    // Keep the first triangle of those that are in the majority, or none.
    const bool twoSided = 2 * opposed > list.size();
    std::vector<char> removed(list.size(), 0);
    for (const Group& group : groups) {
        const std::size_t falling = group.end - group.begin - group.rising;
        bool keep = twoSided || group.rising != falling;
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const bool majority = list[i].rises == (group.rising >= falling);
            removed[list[i].index] = keep && majority ? 0 : 1;
            if (majority) keep = false;
        }
    }
    const std::size_t before = mesh.triangles.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < before; ++i) {
        if (removed[i] == 0) mesh.triangles[kept++] = mesh.triangles[i];
    }
    mesh.triangles.resize(kept);
    return before - kept;
}

}  // namespace bandvox
