#pragma once

#include <bandvox/outline/outline_options.h>

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace bandvox::outline_test {

/// The distance from a surface, about, negative inside; all in the world.
using DistanceFunction = std::function<double(const openvdb::Vec3d&)>;

inline double torusDistance(const openvdb::Vec3d& p) {
    return std::hypot(std::hypot(p[0], p[1]) - 0.7, p[2]) - 0.3;
}

inline double ballDistance(const openvdb::Vec3d& p, const openvdb::Vec3d& center, double radius) {
    return (p - center).length() - radius;
}

/// No distance, but as large near the surface.
inline double ellipsoidDistance(const openvdb::Vec3d& p) {
    const openvdb::Vec3d q(p[0], p[1] / 0.7, p[2] / 0.5);
    const openvdb::Vec3d slope(p[0], p[1] / 0.49, p[2] / 0.25);
    const double k = q.length(), length = slope.length();
    return length > 1e-6 ? k * (k - 1) / length : -0.5;
}

/// 64 voxels along 2 world units.
inline openvdb::math::Transform::Ptr plainLattice() {
    return openvdb::math::Transform::createLinearTransform(2.0 / 64);
}

/// Turned, with voxels that are no cubes.
inline openvdb::math::Transform::Ptr turnedLattice() {
    auto lattice = openvdb::math::Transform::createLinearTransform(2.0 / 64);
    lattice->preScale(openvdb::Vec3d(1, 0.8, 1.2));
    lattice->postRotate(0.5, openvdb::math::X_AXIS);
    lattice->postRotate(0.8, openvdb::math::Z_AXIS);
    lattice->postTranslate(openvdb::Vec3d(0.011, -0.007, 0.013));
    return lattice;
}

/// A level set of what lies within `reach` of the origin, world, with a band of `band` world units.
inline openvdb::FloatGrid::Ptr levelSet(const DistanceFunction& distance,
                                        const openvdb::math::Transform::Ptr& lattice,
                                        double reach = 1.2, double band = 0.2) {
    auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
    grid->setTransform(lattice);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName("surface");
    auto accessor = grid->getAccessor();
    const int half = static_cast<int>(reach * std::sqrt(3.0) / 0.025);
    const openvdb::CoordBBox box(openvdb::Coord(-half), openvdb::Coord(half));
    for (auto it = box.begin(); it; ++it) {
        const double d = distance(grid->indexToWorld(*it));
        if (d >= band) continue;
        if (d > -band) {
            accessor.setValue(*it, static_cast<float>(d));
        } else {
            accessor.setValueOff(*it, static_cast<float>(-band));
        }
    }
    return grid;
}

/// The density of a ball under the default filter, all in voxels.
inline double ballDensity(double r, double radius) {
    const double s = 1 / (std::numbers::pi * 0.16);
    const double a = (radius - r) / s, b = (radius + r) / s;
    return 0.5 * (std::erf(a) + std::erf(b)) -
           s / (2 * r * std::sqrt(std::numbers::pi)) * (std::exp(-a * a) - std::exp(-b * b));
}

/// Where that is one half.
inline double ballSurface(double radius) {
    double inside = 0.5 * radius, outside = 1.5 * radius;
    while (outside - inside > 1e-10) {
        const double middle = 0.5 * (inside + outside);
        (ballDensity(middle, radius) > 0.5 ? inside : outside) = middle;
    }
    return inside;
}

/// A view that does not depend on what is seen: 2.8 world units are 200 units of a page of 220.
inline OutlineOptions fixedView(const openvdb::Vec3d& from, bool isPerspective) {
    OutlineOptions options;
    options.camera.lookat = openvdb::Vec3d(0.0);
    options.camera.up = openvdb::Vec3d(0, 0, 1);
    options.camera.from = from;
    options.width = options.height = 220;
    if (isPerspective) {
        options.camera.eye = 4.5 * from.unit();
        options.camera.aperture = 0.65 * options.camera.focal;
    } else {
        options.camera.projection = CameraOptions::Projection::Orthographic;
        options.camera.frame = 2.8;
    }
    return options;
}

/// Sees places of a page that was made with a fixed view.
class PageCamera {
  public:
    explicit PageCamera(const OutlineOptions& options)
        : mOptions(options),
          mCamera(options.camera, kPixels, kPixels,
                  openvdb::BBoxd(openvdb::Vec3d(-1.0), openvdb::Vec3d(1.0))) {}

    std::array<double, 2> place(const openvdb::Vec3d& world) const {
        const openvdb::Vec2d at = mCamera.project(world);
        return {mOptions.margin + at[0] / scale(), mOptions.margin + at[1] / scale()};
    }

    /// How far a place of the page is from where lines of sight touch a surface, page units: along
    /// one that does, the distance from the surface is 0 where it is least, or largest.
    double fromContour(const std::array<double, 2>& place, const DistanceFunction& distance) const {
        const Ray ray = mCamera.ray((place[0] - mOptions.margin) * scale(),
                                    (place[1] - mOptions.margin) * scale());
        constexpr int kSteps = 400;
        const double middle = -ray.origin.dot(ray.direction), reach = 1.7;
        const auto at = [&](double t) { return distance(ray.origin + t * ray.direction); };
        const auto step = [&](int k) { return middle + reach * (2.0 * k / kSteps - 1); };
        double nearest = HUGE_VAL;
        for (int k = 1; k < kSteps; ++k) {
            const double a = at(step(k - 1)), b = at(step(k)), c = at(step(k + 1));
            if ((b - a) * (c - b) > 0) continue;
            const double sign = b < a || b < c ? 1 : -1;
            double low = step(k - 1), high = step(k + 1);
            for (int n = 0; n < 60; ++n) {
                const double p = low + 0.382 * (high - low), q = low + 0.618 * (high - low);
                (sign * at(p) < sign * at(q) ? high : low) = sign * at(p) < sign * at(q) ? q : p;
            }
            const double t = 0.5 * (low + high);
            const openvdb::Vec3d world = ray.origin + t * ray.direction;
            const double perLength = mCamera.pixelsPerLength(mCamera.depth(world)) / scale();
            nearest = std::min(nearest, std::abs(at(t)) * perLength);
        }
        return nearest;
    }

  private:
    static constexpr int kPixels = 1000;
    double scale() const { return kPixels / (mOptions.width - 2 * mOptions.margin); }

    OutlineOptions mOptions;
    Camera mCamera;
};

}  // namespace bandvox::outline_test
