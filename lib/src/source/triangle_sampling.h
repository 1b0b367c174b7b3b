#pragma once

#include "source/region_clip.h"

#include <bandvox/source/quadrature.h>

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <span>

namespace bandvox {

/// Halvings after which a triangle is taken as it is. Two of them halve its longest edge, so
/// this is enough for 2^32 voxels and ends the recursion on coordinates that make no sense.
inline constexpr int kDeepestTriangleSplit = 64;

/// A part of a triangle that takes one rule. A corner is a place, or has one and more that is
/// linear on the triangle.
template <typename Corner>
struct TriangleCell {
    std::array<Corner, 3> corner;
    double share;  ///< of the triangle's area
    std::span<const TrianglePoint> rule;
};

inline const openvdb::Vec3d& placeOf(const openvdb::Vec3d& corner) {
    return corner;
}
inline openvdb::Vec3d middleOf(const openvdb::Vec3d& a, const openvdb::Vec3d& b) {
    return 0.5 * (a + b);
}

/// The lowest rule that is accurate on a triangle with this longest edge, or kTriangleRules.
inline int lowestTriangleRule(const SurfaceQuadrature& quadrature, double edgeSquared) {
    int rule = 0;
    while (rule < kTriangleRules &&
           quadrature.triangleEdge[rule] * quadrature.triangleEdge[rule] < edgeSquared) {
        ++rule;
    }
    return rule;
}

/// Halves the longest edge of a triangle, and of its halves, until a rule is accurate on what is
/// left, and calls visit(cell) for each part; those that `clip` misses may be left out. `placeOf`
/// and `middleOf` are looked up for Corner.
template <typename Corner, typename Visitor>
void sampleTriangle(const std::array<Corner, 3>& corner, const SurfaceQuadrature& quadrature,
                    const RegionClip& clip, const Visitor& visit, double share = 1, int depth = 0) {
    // Find the longest edge; edge i lies opposite corner i.
    int longest = 0;
    double longestSquared = -1.0;
    for (int i = 0; i < 3; ++i) {
        const double squared =
            (placeOf(corner[(i + 2) % 3]) - placeOf(corner[(i + 1) % 3])).lengthSqr();
        if (squared > longestSquared) {
            longestSquared = squared;
            longest = i;
        }
    }

    const int rule = lowestTriangleRule(quadrature, longestSquared);
    if (rule < kTriangleRules || depth == kDeepestTriangleSplit) {
        visit(
            TriangleCell<Corner>{corner, share, triangleRule(std::min(rule, kTriangleRules - 1))});
        return;
    }

    // Leave out what the region cannot see; this changes no point that it can.
    using openvdb::math::maxComponent;
    using openvdb::math::minComponent;
    const openvdb::Vec3d &a = placeOf(corner[0]), &b = placeOf(corner[1]), &c = placeOf(corner[2]);
    if (clip.misses(minComponent(a, minComponent(b, c)), maxComponent(a, maxComponent(b, c)))) {
        return;
    }

    // Halve the longest edge.
    const Corner& apex = corner[longest];
    const Corner& from = corner[(longest + 1) % 3];
    const Corner& to = corner[(longest + 2) % 3];
    const Corner middle = middleOf(from, to);
    sampleTriangle<Corner>({apex, from, middle}, quadrature, clip, visit, 0.5 * share, depth + 1);
    sampleTriangle<Corner>({apex, middle, to}, quadrature, clip, visit, 0.5 * share, depth + 1);
}

}  // namespace bandvox
