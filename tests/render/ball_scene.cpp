#include "render/ball_scene.h"

#include <bandvox/grid/density_grid.h>

#include <cmath>
#include <numbers>

namespace bandvox::render_test {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

openvdb::FloatGrid::Ptr makeGrid(const openvdb::CoordBBox& box, const ExponentialFilter& filter,
                                 const std::function<double(const Vec3d&)>& density) {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    for (auto it = box.begin(); it; ++it) {
        const auto value = static_cast<float>(density((*it).asVec3d()));
        if (value > 1e-4F) accessor.setValue(*it, value > 0.9999F ? 1.0F : value);
    }
    grid->tree().prune();
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    DensityMetadata metadata;
    metadata.order = filter.order;
    metadata.cutoff = filter.cutoff;
    metadata.tolerance = 1e-4;
    setDensityMetadata(*grid, metadata);
    return grid;
}

double ballDensity(double r, double radius) {
    const double s = 1 / (kPi * ExponentialFilter().cutoff);
    const double a = (radius - r) / s, b = (radius + r) / s;
    if (r < 1e-9) return std::erf(a) - 2 * a / std::sqrt(kPi) * std::exp(-a * a);
    return 0.5 * (std::erf(a) + std::erf(b)) -
           s / (2 * r * std::sqrt(kPi)) * (std::exp(-a * a) - std::exp(-b * b));
}

double ballSurface(double radius, double iso) {
    double inside = 0, outside = radius + 10;
    while (outside - inside > 1e-10) {
        const double middle = 0.5 * (inside + outside);
        (ballDensity(middle, radius) > iso ? inside : outside) = middle;
    }
    return inside;
}

openvdb::FloatGrid::Ptr ballGrid() {
    const Coord middle = Coord::round(kCenter);
    return makeGrid(openvdb::CoordBBox(middle.offsetBy(-26), middle.offsetBy(26)), {},
                    [](const Vec3d& x) { return ballDensity((x - kCenter).length(), kRadius); });
}

RenderOptions smallPicture(int width, int height) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    return options;
}

Vec3d normalAt(const Image& image, std::size_t pixel) {
    return {image.normal[3 * pixel], image.normal[3 * pixel + 1], image.normal[3 * pixel + 2]};
}

Vec3d positionAt(const Image& image, std::size_t pixel) {
    return {image.position[3 * pixel], image.position[3 * pixel + 1],
            image.position[3 * pixel + 2]};
}

RenderOptions frontView(int side, double frame) {
    RenderOptions options = smallPicture(side, side);
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.lookat = kCenter;
    options.camera.eye = kCenter + Vec3d(0, 0, 60);
    options.camera.frame = frame;
    return options;
}

}  // namespace bandvox::render_test
