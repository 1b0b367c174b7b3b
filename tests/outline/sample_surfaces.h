#pragma once

#include "outline/patches/view_patch.h"

#include <bandvox/source/bezier_patch.h>

#include <array>
#include <vector>

namespace bandvox::outline_test {

/// A quarter of a circle as a rational quadratic: (x, y, weight) from (1, 0) to (0, 1).
inline std::array<std::array<double, 3>, 3> quarterCircle() {
    const double w = 0.70710678118654752440;
    return {{{1, 0, 1}, {w, w, w}, {0, 1, 1}}};
}

/// Turns quarter q of a circle, counted counter-clockwise.
inline std::array<double, 3> turned(const std::array<double, 3>& p, int q) {
    switch (q % 4) {
        case 0:
            return p;
        case 1:
            return {-p[1], p[0], p[2]};
        case 2:
            return {-p[0], -p[1], p[2]};
        default:
            return {p[1], -p[0], p[2]};
    }
}

/// A torus about z: its tube, of radius `tube`, is `ring` away from the axis. Outward normals. With
/// ring = 0 and two quarters of the tube it is a sphere, whose patches collapse at the poles.
inline std::vector<BezierPatch> torus(double ring, double tube, bool isSphere = false) {
    std::vector<BezierPatch> patches;
    const auto arc = quarterCircle();
    const std::vector<int> profile =
        isSphere ? std::vector<int>{3, 0} : std::vector<int>{0, 1, 2, 3};
    for (int around = 0; around < 4; ++around) {
        for (const int quarter : profile) {
            BezierPatch patch{.degreeU = 2, .degreeV = 2};
            for (const auto& a : arc) {
                for (const auto& b : arc) {
                    const auto c = turned(a, around);
                    const auto p = turned(b, quarter);
                    // p is (r - ring, z) of the profile, homogeneous.
                    const double r = ring * p[2] + tube * p[0];
                    patch.control.push_back({c[0] * r, c[1] * r, c[2] * tube * p[1], c[2] * p[2]});
                }
            }
            patches.push_back(patch);
        }
    }
    return patches;
}

inline std::vector<BezierPatch> sphere(double radius) {
    return torus(0, radius, true);
}

/// Turns and moves the homogeneous points of patches: rows of a 3 x 4 matrix.
inline std::vector<BezierPatch> mapped(std::vector<BezierPatch> patches,
                                       const std::array<std::array<double, 4>, 3>& m) {
    for (BezierPatch& patch : patches) {
        for (auto& p : patch.control) {
            const auto q = p;
            for (std::size_t r = 0; r < 3; ++r) {
                p[r] = m[r][0] * q[0] + m[r][1] * q[1] + m[r][2] * q[2] + m[r][3] * q[3];
            }
        }
    }
    return patches;
}

}  // namespace bandvox::outline_test
