#include <bandvox/core/error.h>
#include <bandvox/render/placement.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

template <typename Grid>
void placeGrid(std::shared_ptr<const Grid>& grid, const Placement& placement) {
    if (!grid) return;
    const auto transform = grid->transform().copy();
    try {
        transform->postScale(placement.scale);
    } catch (const openvdb::Exception&) {
        throw Error(ErrorKind::Usage, "a scale of " + std::to_string(placement.scale) +
                                          " makes the voxels of the grid '" + grid->getName() +
                                          "' smaller than OpenVDB takes");
    }
    for (int axis = 0; axis < 3; ++axis) {
        transform->postRotate(placement.rotate[axis] * std::numbers::pi / 180,
                              openvdb::math::Axis(axis));
    }
    transform->postTranslate(placement.translate);
    grid = grid->copyReplacingTransform(transform);
}

}  // namespace

void place(SceneObject& object, const Placement& placement) {
    if (!(placement.scale > 0 && std::isfinite(placement.scale))) {
        throw Error(ErrorKind::Usage, "a scale is " + std::to_string(placement.scale) +
                                          "; expected a number above 0");
    }
    if (placement.isIdentity()) return;
    placeGrid(object.grid, placement);
    placeGrid(object.colors, placement);
    placeGrid(object.temperatures, placement);
}

}  // namespace bandvox
