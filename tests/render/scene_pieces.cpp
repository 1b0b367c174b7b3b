#include "render/scene_pieces.h"

#include <cmath>
#include <numbers>

namespace bandvox::render_test {

using openvdb::Vec3d;

double faceDensity(double distance) {
    return 0.5 * std::erfc(std::numbers::pi * ExponentialFilter().cutoff * distance);
}

openvdb::FloatGrid::Ptr boxGrid(const openvdb::BBoxd& box) {
    openvdb::CoordBBox voxels(openvdb::Coord::floor(box.min()), openvdb::Coord::ceil(box.max()));
    voxels.expand(8);
    return makeGrid(voxels, {}, [&box](const Vec3d& x) {
        double density = 1;
        for (int axis = 0; axis < 3; ++axis) {
            density *=
                faceDensity(x[axis] - box.max()[axis]) - faceDensity(x[axis] - box.min()[axis]);
        }
        return density;
    });
}

openvdb::FloatGrid::Ptr ballAt(const Vec3d& middle) {
    auto grid = ballGrid();
    auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    transform->postTranslate(middle - kCenter);
    grid->setTransform(transform);
    return grid;
}

SceneObject surfaceOf(const openvdb::FloatGrid::ConstPtr& grid, const Material& material) {
    SceneObject object;
    object.grid = grid;
    object.material = material;
    return object;
}

Environment furnace() {
    Environment environment;
    environment.color = Vec3d(1.0);
    return environment;
}

PictureOptions pictureFrom(const Vec3d& direction, const Vec3d& lookat, int side, double frame) {
    PictureOptions options;
    options.width = options.height = side;
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.lookat = lookat;
    options.camera.eye = lookat + 100 * direction.unit();
    options.camera.frame = frame;
    return options;
}

Vec3d colorAt(const Image& image, int column, int row) {
    const float* color = &image.color[4 * (static_cast<std::size_t>(row) * image.width + column)];
    return {color[0], color[1], color[2]};
}

}  // namespace bandvox::render_test
