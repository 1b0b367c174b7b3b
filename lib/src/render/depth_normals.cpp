#include "render/depth_normals.h"

#include <cmath>
#include <cstdlib>

namespace bandvox {

using openvdb::Vec3d;

// What a pixel sees, if it is one of the picture and sees something.
std::optional<Vec3d> DepthNormals::position(const Pixel& pixel) const {
    if (pixel.column < 0 || pixel.column >= mBuffer.width || pixel.row < 0 ||
        pixel.row >= mBuffer.height) {
        return std::nullopt;
    }
    const double t =
        mBuffer.distance[static_cast<std::size_t>(pixel.row) * mBuffer.width + pixel.column];
    if (std::isinf(t)) return std::nullopt;
    const Ray ray = mCamera.ray(pixel.column + mBuffer.place[0], pixel.row + mBuffer.place[1]);
    return ray.origin + t * ray.direction;
}

// From the pixel before to the one after `middle`: two steps.
std::optional<Vec3d> DepthNormals::difference(const Pixel& middle, const Pixel& step) const {
    const auto before = position(middle - step), after = position(middle + step);
    if (before && after) return *after - *before;
    const auto between = position(middle);
    if (!between) return std::nullopt;
    if (after) return 2.0 * (*after - *between);
    if (before) return 2.0 * (*between - *before);
    return std::nullopt;
}

// The mean of the differences along `step` in three rows.
std::optional<Vec3d> DepthNormals::slope(const Pixel& middle, const Pixel& step) const {
    const Pixel aside{std::abs(step.row), std::abs(step.column)};
    Vec3d sum(0.0);
    int weights = 0;
    const auto add = [&](const Pixel& pixel, int weight) {
        if (weight == 0) return;
        if (const auto found = difference(pixel, step)) {
            sum += weight * *found;
            weights += weight;
        }
    };
    // Both rows beside first: their sum does not depend on which is which.
    add(middle - aside, mWeights.beside);
    add(middle + aside, mWeights.beside);
    add(middle, mWeights.own);
    if (weights == 0) return std::nullopt;
    return sum / weights;
}

Vec3d DepthNormals::at(int column, int row) const {
    const Vec3d across = slope({column, row}, {1, 0}).value_or(mCamera.right());
    const Vec3d upward = slope({column, row}, {0, -1}).value_or(mCamera.upward());
    const Vec3d normal = across.cross(upward);
    const double length = normal.length();
    return length > 0 ? normal / length : -mCamera.forward();
}

}  // namespace bandvox
