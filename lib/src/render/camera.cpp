#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/render/camera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

// Room left around a framed object, relative to its size in the picture.
constexpr double kFrameMargin = 1.04;
// The same around what is faint: half a pixel of a picture of 128.
constexpr double kFaintMargin = 1.008;
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

// Of all points, by many threads: add(point, part) puts one to a part, join(part, other) one part
// to another.
template <typename Part, typename Add, typename Join>
Part reduced(std::span<const openvdb::Vec3d> points, const Part& none, const Add& add,
             const Join& join) {
    constexpr std::size_t kTogether = 32768;
    std::vector<Part> parts((points.size() + kTogether - 1) / kTogether, none);
    parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        const std::size_t first = k * kTogether;
        const std::size_t count = std::min(kTogether, points.size() - first);
        Part part = none;
        for (const openvdb::Vec3d& point : points.subspan(first, count)) add(point, part);
        parts[k] = part;
    });
    Part all = none;
    for (const Part& part : parts) join(all, part);
    return all;
}

openvdb::Vec3d middleOf(std::span<const openvdb::Vec3d> points) {
    return reduced(
               points, openvdb::BBoxd(),
               [](const openvdb::Vec3d& p, openvdb::BBoxd& box) { box.expand(p); },
               [](openvdb::BBoxd& box, const openvdb::BBoxd& other) { box.expand(other); })
        .getCenter();
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far points reach from a center: to the right and upward, brought along the view's borders to
// the plane through the center, and in depth.
struct Reach {
    std::array<double, 2> low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
    double near = kInfinity, far = -kInfinity;

    void join(const Reach& other) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], other.low[axis]);
            high[axis] = std::max(high[axis], other.high[axis]);
        }
        near = std::min(near, other.near);
        far = std::max(far, other.far);
    }
};

// A point c at forward distance d is seen by an eye at distance D if |c - middle| ≤ t (D + d), t =
// `tangents`; 0 for a parallel view.
Reach reachOf(std::span<const openvdb::Vec3d> points, const openvdb::Vec3d& center,
              const Camera& camera, const std::array<double, 2>& tangents) {
    const auto add = [&](const openvdb::Vec3d& point, Reach& reach) {
        const openvdb::Vec3d offset = point - center;
        const double across[] = {offset.dot(camera.right()), offset.dot(camera.upward())};
        const double forward = offset.dot(camera.forward());
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double spread = tangents[axis] * forward;
            reach.low[axis] = std::min(reach.low[axis], across[axis] + spread);
            reach.high[axis] = std::max(reach.high[axis], across[axis] - spread);
        }
        reach.near = std::min(reach.near, forward);
        reach.far = std::max(reach.far, forward);
    };
    return reduced(points, Reach(), add, [](Reach& a, const Reach& b) { a.join(b); });
}

// What points take up along one axis of the picture, on the plane through their center: reach is
// t D, or half the width of a parallel view.
struct Fit {
    double middle, reach;
};

Fit fit(const Reach& reach, std::size_t axis, bool centered) {
    const double low = reach.low[axis], high = reach.high[axis];
    if (centered) return {0.5 * (high + low), 0.5 * (high - low)};
    return {0, std::max(high, -low)};
}

// The reach of others around a middle that is there; minus infinity if there are none.
double reachAround(double middle, const Reach& reach, std::size_t axis) {
    return std::max(reach.high[axis] - middle, middle - reach.low[axis]);
}

}  // namespace

void requireValid(const CameraOptions& options) {
    const auto isLength = [](double mm) { return mm >= 1e-3 && mm <= 1e6; };
    if (!isLength(options.focal)) refuse("focal length, mm,", options.focal, "0.001 to 1000000");
    if (!isLength(options.aperture)) refuse("aperture, mm,", options.aperture, "0.001 to 1000000");
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
               std::span<const openvdb::Vec3d> object, std::span<const openvdb::Vec3d> faint)
    : mProjection(options.projection), mPixelsWide(width), mPixelsHigh(height) {
    // Refuse what defines no view.
    const bool perspective = mProjection == CameraOptions::Projection::Perspective;
    if (!(width > 0 && height > 0)) {
        refuse("picture's smaller side, in pixels,", std::min(width, height), "at least 1");
    }
    requireValid(options);

    // Turn the axes.
    const openvdb::Vec3d lookat = options.lookat ? *options.lookat : middleOf(object);
    const openvdb::Vec3d back = directionBack(options, lookat);
    mForward = -back;
    mRight = directionRight(options, back);
    mUpward = mRight.cross(mForward);

    // Frame the object, around the lookat if that was given, else in the middle of the picture.
    const double aspect = mPixelsHigh / mPixelsWide;
    const bool centered = !options.eye && !options.lookat;
    if (perspective) mHalfWidth = 0.5 * options.aperture / options.focal;
    const double tangent = perspective ? mHalfWidth / kFrameMargin : 0;
    const Reach reach = reachOf(object, lookat, *this, {tangent, tangent * aspect});
    const Fit across = fit(reach, 0, centered);
    const Fit along = fit(reach, 1, centered);
    const double faintTangent = perspective ? mHalfWidth / kFaintMargin : 0;
    const Reach faintReach = reachOf(faint, lookat, *this, {faintTangent, faintTangent * aspect});
    const double faintAcross = reachAround(across.middle, faintReach, 0);
    const double faintAlong = reachAround(along.middle, faintReach, 1);
    const double near = object.empty() ? 0 : reach.near;
    const double far = object.empty() ? 0 : reach.far;
    double distance = 0;
    if (perspective) {
        distance = std::max(across.reach / tangent, along.reach / (tangent * aspect));
        // What ends in a point towards the eye must not reach behind it.
        distance = std::max(distance, kLeastDistance * (far - near) - near);
        distance = std::max({distance, faintAcross / faintTangent,
                             faintAlong / (faintTangent * aspect), -faintReach.near});
    } else {
        double fitted = std::max(across.reach, along.reach / aspect);
        // A line that is seen along itself has no width.
        if (!(fitted > 0)) fitted = far - near;
        const double faintlyFitted = std::max(faintAcross, faintAlong / aspect);
        mHalfWidth = options.frame > 0
                         ? 0.5 * options.frame
                         : std::max(kFrameMargin * fitted, kFaintMargin * faintlyFitted);
        distance = std::max({distance, fitted - near, -faintReach.near});
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
