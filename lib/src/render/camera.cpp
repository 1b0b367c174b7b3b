#include <bandvox/core/error.h>
#include <bandvox/render/camera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

// Room left around a framed object, relative to its size in the picture.
constexpr double kFrameMargin = 1.04;
// Between the eye and a framed object, relative to the object's depth.
constexpr double kLeastDistance = 0.1;

// Directions closer to each other than this, as a sine, do not span a plane.
constexpr double kSmallestSine = 1e-6;

[[noreturn]] void refuse(const char* what, double found, const char* expected) {
    std::ostringstream message;
    message << "the camera's " << what << " is " << found << "; it must be " << expected;
    throw Error(ErrorKind::Usage, message.str());
}

bool isFinite(const openvdb::Vec3d& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

openvdb::Vec3d requireDirection(const openvdb::Vec3d& v, const char* what) {
    const double length = v.length();
    if (!std::isfinite(length) || !(length > 0)) {
        std::ostringstream message;
        message << "the camera's " << what << " is " << v << "; it must not be zero, nor infinite";
        throw Error(ErrorKind::Usage, message.str());
    }
    return v / length;
}

// From what is looked at to the eye.
openvdb::Vec3d directionBack(const CameraOptions& options, const openvdb::Vec3d& lookat) {
    if (!options.eye) return requireDirection(options.from, "from");
    if (*options.eye == lookat) {
        std::ostringstream message;
        message << "the camera's eye is " << *options.eye << ", and that is "
                << (options.lookat ? "its lookat" : "the middle of the object, which it looks at")
                << "; expected two places";
        throw Error(ErrorKind::Usage, message.str());
    }
    return requireDirection(*options.eye - lookat, "eye minus its lookat");
}

// The direction to the right in the picture, of length 1.
openvdb::Vec3d directionRight(const CameraOptions& options, const openvdb::Vec3d& back) {
    openvdb::Vec3d right =
        requireDirection(options.up.value_or(openvdb::Vec3d(0, 1, 0)), "up").cross(back);
    // From straight above the far side, -z, is up, as on a map; from straight below z is.
    if (!options.up && !(right.length() > kSmallestSine)) {
        right = openvdb::Vec3d(0, 0, back[1] > 0 ? -1 : 1).cross(back);
    }
    if (!(right.length() > kSmallestSine)) {
        std::ostringstream message;
        message << "the camera's up is " << *options.up
                << ", along the view; expected another direction";
        throw Error(ErrorKind::Usage, message.str());
    }
    return right.unit();
}

std::array<openvdb::Vec3d, 8> cornersOf(const openvdb::BBoxd& box) {
    std::array<openvdb::Vec3d, 8> corners;
    for (int i = 0; i < 8; ++i) {
        corners[i] = {i & 1 ? box.max()[0] : box.min()[0], i & 2 ? box.max()[1] : box.min()[1],
                      i & 4 ? box.max()[2] : box.min()[2]};
    }
    return corners;
}

openvdb::Vec3d middleOf(std::span<const openvdb::Vec3d> points) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& p : points) box.expand(p);
    return box.getCenter();
}

// Points relative to `center`, along the camera's axes: right, up, forward.
std::vector<openvdb::Vec3d> seenFrom(const openvdb::Vec3d& center, const Camera& camera,
                                     std::span<const openvdb::Vec3d> points) {
    std::vector<openvdb::Vec3d> seen;
    seen.reserve(points.size());
    for (const openvdb::Vec3d& point : points) {
        const openvdb::Vec3d offset = point - center;
        seen.emplace_back(offset.dot(camera.right()), offset.dot(camera.upward()),
                          offset.dot(camera.forward()));
    }
    return seen;
}

// What points take up along one axis of the picture, on the plane through their center.
struct Fit {
    double middle, reach;
};

// A point c at forward distance d is seen by an eye at distance D if |c - middle| ≤ t (D + d),
// t = `tangent`; then reach = t D. For t = 0, orthographic, it is half the width.
Fit fit(std::span<const openvdb::Vec3d> points, int axis, double tangent, bool centered) {
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    for (const openvdb::Vec3d& point : points) {
        high = std::max(high, point[axis] - tangent * point[2]);
        low = std::min(low, point[axis] + tangent * point[2]);
    }
    if (centered) return {0.5 * (high + low), 0.5 * (high - low)};
    return {0, std::max(high, -low)};
}

// The smallest and the largest forward distance of points from their center.
std::pair<double, double> depthsOf(std::span<const openvdb::Vec3d> points) {
    if (points.empty()) return {0, 0};
    const auto isNearer = [](const openvdb::Vec3d& a, const openvdb::Vec3d& b) {
        return a[2] < b[2];
    };
    const auto [near, far] = std::minmax_element(points.begin(), points.end(), isNearer);
    return {(*near)[2], (*far)[2]};
}

}  // namespace

void requireValid(const CameraOptions& options) {
    if (!(options.focal > 0) || !std::isfinite(options.focal)) {
        refuse("focal length, mm,", options.focal, "above 0");
    }
    if (!(options.aperture > 0) || !std::isfinite(options.aperture)) {
        refuse("aperture, mm,", options.aperture, "above 0");
    }
    if (!(options.frame >= 0) || !std::isfinite(options.frame)) {
        refuse("frame, world units,", options.frame, "above 0, or 0 to fit");
    }
    if (options.up) requireDirection(*options.up, "up");
    if (options.lookat && !isFinite(*options.lookat)) requireDirection(*options.lookat, "lookat");
    if (options.eye && !isFinite(*options.eye)) requireDirection(*options.eye, "eye");
    // Without a lookat the object says where an eye looks to.
    if (options.eye && !options.lookat) return;
    directionRight(options, directionBack(options, options.lookat.value_or(openvdb::Vec3d(0.0))));
}

Camera::Camera(const CameraOptions& options, int width, int height, const openvdb::BBoxd& object)
    : Camera(options, width, height, cornersOf(object)) {}

Camera::Camera(const CameraOptions& options, int width, int height,
               std::span<const openvdb::Vec3d> object)
    : mProjection(options.projection), mPixelsWide(width), mPixelsHigh(height) {
    // Refuse what defines no view.
    const bool perspective = mProjection == CameraOptions::Projection::Perspective;
    if (!(width > 0 && height > 0)) {
        refuse("picture's smaller side, in pixels,", std::min(width, height), "at least 1");
    }
    requireValid(options);

    // Turn the axes.
    const openvdb::Vec3d lookat = options.lookat.value_or(middleOf(object));
    const openvdb::Vec3d back = directionBack(options, lookat);
    mForward = -back;
    mRight = directionRight(options, back);
    mUpward = mRight.cross(mForward);

    // Frame the object, around the lookat if that was given, else in the middle of the picture.
    const double aspect = mPixelsHigh / mPixelsWide;
    const bool centered = !options.eye && !options.lookat;
    const std::vector<openvdb::Vec3d> points = seenFrom(lookat, *this, object);
    if (perspective) mHalfWidth = 0.5 * options.aperture / options.focal;
    const double tangent = perspective ? mHalfWidth / kFrameMargin : 0;
    const Fit across = fit(points, 0, tangent, centered);
    const Fit along = fit(points, 1, tangent * aspect, centered);
    const auto [near, far] = depthsOf(points);
    double distance = 0;
    if (perspective) {
        distance = std::max(across.reach / tangent, along.reach / (tangent * aspect));
        // What ends in a point towards the eye must not reach behind it.
        distance = std::max(distance, kLeastDistance * (far - near) - near);
    } else {
        double fitted = std::max(across.reach, along.reach / aspect);
        // A line that is seen along itself has no width.
        if (!(fitted > 0)) fitted = far - near;
        mHalfWidth = options.frame > 0 ? 0.5 * options.frame : kFrameMargin * fitted;
        distance = std::max(distance, fitted - near);
    }
    mHalfHeight = mHalfWidth * aspect;
    mEye = options.eye.value_or(lookat - distance * mForward + across.middle * mRight +
                                along.middle * mUpward);
    if (!(mHalfWidth > 0)) refuse("view's width", 2 * mHalfWidth, "above 0");
}

Ray Camera::ray(double x, double y) const {
    const double across = (2 * x / mPixelsWide - 1) * mHalfWidth;
    const double along = (1 - 2 * y / mPixelsHigh) * mHalfHeight;
    const openvdb::Vec3d offset = across * mRight + along * mUpward;
    if (mProjection == CameraOptions::Projection::Orthographic) return {mEye + offset, mForward};
    return {mEye, (mForward + offset).unit()};
}

openvdb::Vec2d Camera::project(const openvdb::Vec3d& point) const {
    const openvdb::Vec3d offset = point - mEye;
    const double scale =
        mProjection == CameraOptions::Projection::Orthographic ? 1 : 1 / offset.dot(mForward);
    return {0.5 * mPixelsWide * (1 + scale * offset.dot(mRight) / mHalfWidth),
            0.5 * mPixelsHigh * (1 - scale * offset.dot(mUpward) / mHalfHeight)};
}

double Camera::pixelsPerLength(double depth) const {
    const double scale = mProjection == CameraOptions::Projection::Orthographic ? 1 : 1 / depth;
    return 0.5 * mPixelsWide * scale / mHalfWidth;
}

openvdb::math::Mat4d Camera::worldToCamera() const {
    openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
    const openvdb::Vec3d axes[] = {mRight, mUpward, mForward};
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) matrix(row, column) = axes[column][row];
        matrix(3, column) = -mEye.dot(axes[column]);
    }
    return matrix;
}

openvdb::math::Mat4d Camera::worldToScreen() const {
    openvdb::math::Mat4d projection = openvdb::math::Mat4d::identity();
    projection(0, 0) = 1 / mHalfWidth;
    projection(1, 1) = 1 / mHalfHeight;
    if (mProjection == CameraOptions::Projection::Perspective) {
        projection(2, 3) = 1;
        projection(3, 3) = 0;
    }
    return worldToCamera() * projection;
}

double Camera::depth(const openvdb::Vec3d& point) const {
    return (point - mEye).dot(mForward);
}

}  // namespace bandvox
