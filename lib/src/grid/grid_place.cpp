#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/source/world_space.h>

namespace bandvox {

namespace {

// Vectors that are no directions, of which nothing turns.
bool turnsWithWorld(const openvdb::GridBase& grid) {
    const bool isVector = grid.valueType().starts_with("vec3");
    return isVector && grid.getVectorType() != openvdb::VEC_INVARIANT;
}

}  // namespace

std::string placeDifference(const openvdb::GridBase& first, const openvdb::GridBase& other) {
    const PlaceMetadata a = placeMetadata(first), b = placeMetadata(other);
    const std::string spaces[] = {worldSpaceName(a.space), worldSpaceName(b.space)};
    std::string text;
    if (!spaces[0].empty() && !spaces[1].empty() && spaces[0] != spaces[1]) {
        text += "the first has axes " + spaces[0] + ", the other " + spaces[1];
    }
    if (!a.unit.empty() && !b.unit.empty() && a.unit != b.unit) {
        if (!text.empty()) text += "; ";
        text += "the first has lengths in " + a.unit + ", the other in " + b.unit;
    }
    return text;
}

void turnToSpace(openvdb::GridBase& grid, const std::string& space) {
    const PlaceMetadata place = placeMetadata(grid);
    const auto turn = spaceToSpace(place.space, space);
    std::string name = "the grid '" + grid.getName();
    name += "' cannot be brought to the space " + space + ": ";
    if (!turn) {
        throw Error(ErrorKind::Usage,
                    name + (place.space.empty() ? "it does not say where its axes point"
                                                : "its own is '" + place.space + "'"));
    }
    if (turnsWithWorld(grid)) {
        throw Error(ErrorKind::Usage, name + "its values are directions or places themselves");
    }
    if (!grid.transform().isLinear()) {
        throw Error(ErrorKind::Usage, name + "its transform is not linear");
    }
    const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    grid.setTransform(openvdb::math::Transform::createLinearTransform(matrix * *turn));
    setPlaceMetadata(grid, {"", worldSpaceName(space)});
}

}  // namespace bandvox
