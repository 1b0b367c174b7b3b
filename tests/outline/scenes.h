#pragma once

#include "build_places.h"
#include "outline/sample_surfaces.h"

#include <bandvox/outline/patches_to_outline.h>
#include <bandvox/source/bspline_patch.h>
#include <bandvox/source/read_patches.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::outline_test {

/// Surfaces that hide, pass through and graze each other.
struct Scene {
    std::string name;
    std::vector<BezierPatch> patches;
};

inline std::vector<BezierPatch> teapot() {
    const auto folder = std::filesystem::path(build_places::sources()) / "examples" / "data";
    return readPatches(folder / "teapot.bpt").patches;
}

inline std::vector<BezierPatch> together(std::vector<BezierPatch> a,
                                         const std::vector<BezierPatch>& b) {
    for (BezierPatch patch : b) {
        patch.object = 1;
        a.push_back(patch);
    }
    return a;
}

/// Two teapots, one turned about z and moved, that pass through each other.
inline std::vector<BezierPatch> twoTeapots() {
    return together(teapot(),
                    mapped(teapot(), {{{0.6, -0.8, 0, 0.7}, {0.8, 0.6, 0, 0.4}, {0, 0, 1, 0.5}}}));
}

/// Two tori whose tubes pass through each other.
inline std::vector<BezierPatch> twoTori() {
    return together(torus(1, 0.4), mapped(torus(0.9, 0.33), {{{0.31, 0.11, 0.944, 0.83},
                                                              {-0.78, 0.6, 0.18, 0.21},
                                                              {-0.546, -0.79, 0.272, 0.13}}}));
}

/// A tube along a helix, the thicker and the nearer to the axis the higher, open at both ends:
/// where it is thicker than a turn is high it passes through itself.
inline std::vector<BezierPatch> spiral() {
    constexpr int kAlong = 21, kAround = 8, kDegree = 3;
    BsplineNet net{.degree = {kDegree, kDegree}, .count = {kAlong, kAround + kDegree}};
    for (int axis = 0; axis < 2; ++axis) {
        for (int k = 0; k < net.count[static_cast<std::size_t>(axis)] + kDegree + 1; ++k) {
            net.knots[static_cast<std::size_t>(axis)].push_back(k);
        }
    }
    for (int k = 0; k < kAlong; ++k) {
        const double share = double(k) / (kAlong - 1);
        const double turn = 2 * std::numbers::pi * 2.4 * share;
        const double radius = 1.2 - 0.35 * share, tube = 0.16 + 0.52 * share * share;
        for (int j = 0; j < kAround + kDegree; ++j) {
            const double angle = -2 * std::numbers::pi * j / kAround;
            const double r = radius + tube * std::cos(angle);
            net.control.push_back(
                {r * std::cos(turn), r * std::sin(turn), 1.55 * share + tube * std::sin(angle), 1});
        }
    }
    return bezierPatches(net);
}

inline std::vector<Scene> scenes() {
    return {{"teapot", teapot()},
            {"two teapots", twoTeapots()},
            {"two tori", twoTori()},
            {"spiral", spiral()}};
}

inline OutlineOptions viewFrom(double azimuth, double elevation, bool isPerspective) {
    OutlineOptions options;
    using Projection = CameraOptions::Projection;
    options.camera.projection = isPerspective ? Projection::Perspective : Projection::Orthographic;
    options.camera.from =
        openvdb::Vec3d(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    options.camera.up = openvdb::Vec3d(0, 0, 1);
    return options;
}

/// A view along parallel lines of sight whose 200 of 220 page units are `frame` world units.
inline OutlineOptions parallelView(const openvdb::Vec3d& from, double frame) {
    OutlineOptions options;
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.from = from;
    options.camera.frame = frame;
    options.camera.lookat = openvdb::Vec3d(0.0);
    options.camera.up = openvdb::Vec3d(0, 0, 1);
    options.width = options.height = 220;
    options.margin = 10;
    return options;
}

}  // namespace bandvox::outline_test
