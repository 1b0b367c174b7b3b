#pragma once

#include <bandvox/source/bezier_patch.h>

#include <openvdb/Types.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace bandvox {

/// Three homogeneous control points of an arc of a circle about the origin, in a plane; angles in
/// radians, less than π apart.
inline std::array<std::array<double, 3>, 3> arcControl(double from, double to) {
    const double w = std::cos(0.5 * (to - from));
    const double middle = 0.5 * (from + to);
    return {{{std::cos(from), std::sin(from), 1},
             {std::cos(middle), std::sin(middle), w},
             {std::cos(to), std::sin(to), 1}}};
}

/// The surface that a curve (distance from z, height, weight) makes as it turns about z, as four
/// rational patches of degree 2 along u.
inline std::vector<BezierPatch> revolved(const std::vector<std::array<double, 3>>& curve,
                                         const openvdb::Vec3d& center) {
    std::vector<BezierPatch> patches;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const auto turn =
            arcControl(0.5 * std::numbers::pi * quarter, 0.5 * std::numbers::pi * (quarter + 1));
        BezierPatch patch{.degreeU = 2, .degreeV = static_cast<int>(curve.size()) - 1};
        for (const auto& t : turn) {
            for (const auto& c : curve) {
                const double w = t[2] * c[2];
                patch.control.push_back({t[0] * c[0] + w * center[0], t[1] * c[0] + w * center[1],
                                         t[2] * c[1] + w * center[2], w});
            }
        }
        patches.push_back(patch);
    }
    return patches;
}

/// A torus about z, as sixteen patches.
inline std::vector<BezierPatch> torusPatches(double radius, double tube) {
    std::vector<BezierPatch> patches;
    for (int quarter = 0; quarter < 4; ++quarter) {
        std::vector<std::array<double, 3>> curve;
        for (const auto& p :
             arcControl(0.5 * std::numbers::pi * quarter, 0.5 * std::numbers::pi * (quarter + 1))) {
            curve.push_back({radius * p[2] + tube * p[0], tube * p[1], p[2]});
        }
        for (BezierPatch& patch : revolved(curve, openvdb::Vec3d(0))) patches.push_back(patch);
    }
    return patches;
}

/// A ball's surface as eight rational patches, collapsed at the poles.
inline std::vector<BezierPatch> spherePatches(const openvdb::Vec3d& center, double radius) {
    std::vector<BezierPatch> patches;
    for (int half = -1; half < 1; ++half) {
        std::vector<std::array<double, 3>> curve;
        for (const auto& p :
             arcControl(0.5 * std::numbers::pi * half, 0.5 * std::numbers::pi * (half + 1))) {
            curve.push_back({radius * p[0], radius * p[1], p[2]});
        }
        // At the pole the distance is none at all, not a rounding error.
        curve[half < 0 ? 0 : 2][0] = 0;
        for (BezierPatch& patch : revolved(curve, center)) patches.push_back(patch);
    }
    return patches;
}

/// The open mantle of a cylinder about z, upwards from 0.
inline std::vector<BezierPatch> cylinderPatches(double radius, double height) {
    return revolved({{radius, 0, 1}, {radius, height, 1}}, openvdb::Vec3d(0));
}

/// The same patch seen from its other side.
inline BezierPatch turnedOver(const BezierPatch& patch) {
    BezierPatch result = patch;
    for (int i = 0; i <= patch.degreeU; ++i) {
        for (int j = 0; j <= patch.degreeV; ++j) result.at(i, j) = patch.at(patch.degreeU - i, j);
    }
    return result;
}

/// A closed strip of eight ruled patches, turned by so many halves on its way.
inline std::vector<BezierPatch> stripPatches(int halves) {
    constexpr int kCount = 8;
    const auto edge = [halves](int k) {
        const double angle = 2 * std::numbers::pi * (k % kCount) / kCount;
        double tilt = 0.4 + 0.5 * halves * angle;
        if (k == kCount) tilt += halves * std::numbers::pi;
        std::array<std::array<double, 4>, 2> ends;
        for (std::size_t side = 0; side < 2; ++side) {
            const double off = side == 0 ? -0.3 : 0.3;
            const double r = 1 + off * std::cos(tilt);
            ends[side] = {r * std::cos(angle), r * std::sin(angle), off * std::sin(tilt), 1};
        }
        return ends;
    };
    std::vector<BezierPatch> patches;
    for (int k = 0; k < kCount; ++k) {
        const auto a = edge(k), b = edge(k + 1);
        patches.push_back({.degreeU = 1, .degreeV = 1, .control = {a[0], a[1], b[0], b[1]}});
    }
    return patches;
}

}  // namespace bandvox
