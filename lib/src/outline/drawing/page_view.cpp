#include "outline/drawing/page_view.h"

#include <bandvox/core/error.h>
#include <bandvox/render/camera.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {
namespace {

// Points that are framed: of the surfaces, not of their control nets, which are larger.
std::vector<openvdb::Vec3d> framedPoints(const std::vector<BezierPatch>& patches) {
    constexpr int kSteps = 8;
    std::vector<openvdb::Vec3d> points;
    for (const BezierPatch& patch : patches) {
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; j <= kSteps; ++j) {
                const auto p = evaluate(patch, double(i) / kSteps, double(j) / kSteps).position;
                points.emplace_back(p[0], p[1], p[2]);
            }
        }
    }
    return points;
}

// The view as a map to the page. What is at the edge of the film lies at the edge of what the
// margin leaves.
ViewMatrix viewOf(const Camera& camera, const OutlineOptions& options) {
    const openvdb::math::Mat4d screen = camera.worldToScreen();
    const double wide = 0.5 * options.width - options.margin;
    const double high = 0.5 * options.height - options.margin;
    ViewMatrix view{};
    const bool isPerspective = camera.projection() == CameraOptions::Projection::Perspective;
    for (int c = 0; c < 4; ++c) {
        const auto k = static_cast<std::size_t>(c);
        view[3][k] = screen(c, 3);
        view[0][k] = wide * screen(c, 0) + 0.5 * options.width * screen(c, 3);
        view[1][k] = -high * screen(c, 1) + 0.5 * options.height * screen(c, 3);
        view[2][k] = isPerspective ? (c == 3 ? -1 : 0) : screen(c, 2);
    }
    return view;
}

double rowTimes(const std::array<double, 4>& row, const std::array<double, 4>& p) {
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] * p[3];
}

void settle(ViewMatrix& view, const PageContent& content, double size, double turn) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& p : content.enclosing) {
        const double w = rowTimes(view[3], p);
        if (!(w > 0)) {
            throw Error(ErrorKind::Usage,
                        "a surface reaches behind the eye; expected all of it before the eye: "
                        "an eye that is farther away, or an orthographic view");
        }
        const double depth = rowTimes(view[2], p) / w;
        low = std::min(low, depth);
        high = std::max(high, depth);
    }
    const double scale = size / std::max(high - low, 1e-9 * std::max(std::abs(high), 1e-300));
    const double middle = 0.5 * (low + high);
    // In no direction that anything is likely to have.
    const double turnX = 0.804176 * turn, turnY = 0.594391 * turn;
    for (std::size_t c = 0; c < 4; ++c) {
        view[2][c] = scale * (view[2][c] - middle * view[3][c]);
        view[0][c] += turnX * view[2][c];
        view[1][c] += turnY * view[2][c];
    }
}

}  // namespace

PageContent contentOf(const std::vector<BezierPatch>& patches) {
    PageContent content{framedPoints(patches), {}};
    for (const BezierPatch& patch : patches) {
        content.enclosing.insert(content.enclosing.end(), patch.control.begin(),
                                 patch.control.end());
    }
    return content;
}

Camera pageCamera(const PageContent& content, const OutlineOptions& options) {
    // The camera's pixels only serve for the shape of the picture.
    const double wide = options.width - 2 * options.margin;
    const double high = options.height - 2 * options.margin;
    const double pixels = 20000 / std::max(wide, high);
    const auto cameraOf = [&](const std::vector<openvdb::Vec3d>& framed) {
        return Camera(options.camera, static_cast<int>(std::ceil(pixels * wide)),
                      static_cast<int>(std::ceil(pixels * high)), framed);
    };
    const Camera camera = cameraOf(content.framed);
    if (options.camera.eye) return camera;
    // What encloses the surfaces may be much larger than they are: then the eye goes farther away.
    std::vector<openvdb::Vec3d> all = content.framed;
    bool isBefore = true;
    for (const auto& p : content.enclosing) {
        all.push_back(openvdb::Vec3d(p[0], p[1], p[2]) / p[3]);
        isBefore = isBefore && camera.depth(all.back()) > 0;
    }
    return isBefore ? camera : cameraOf(all);
}

std::array<double, 3> lightDirection(const PageContent& content, const OutlineOptions& options) {
    const Camera camera = pageCamera(content, options);
    const auto& light = options.light;
    const openvdb::Vec3d direction =
        (light[0] * camera.right() + light[1] * camera.upward() - light[2] * camera.forward())
            .unit();
    return {direction[0], direction[1], direction[2]};
}

ViewMatrix pageView(const PageContent& content, const OutlineOptions& options, double turn) {
    ViewMatrix view = viewOf(pageCamera(content, options), options);
    settle(view, content, std::max(options.width, options.height), turn);
    return view;
}

ViewMatrix pageView(const std::vector<BezierPatch>& patches, const OutlineOptions& options) {
    constexpr double kTurn = 2.86007e-7;
    return pageView(contentOf(patches), options, kTurn);
}

}  // namespace bandvox
