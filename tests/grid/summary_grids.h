#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <random>

// Grids that the summaries are tested with.
namespace bandvox::summary_grids {

/// Leaves, active and inactive tiles, and values that differ from the background without being
/// active, in a box of about 60 × 40 × 30 voxels that starts at no round place.
inline openvdb::FloatGrid::Ptr mixedGrid(const openvdb::Vec3d& voxel = openvdb::Vec3d(1.0)) {
    using openvdb::Coord;
    auto grid = openvdb::FloatGrid::create(-0.25F);
    openvdb::Mat4R matrix = openvdb::Mat4R::identity();
    for (int axis = 0; axis < 3; ++axis) matrix(axis, axis) = voxel[axis];
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(-1, 1);
    for (int i = 0; i < 4000; ++i) {
        const Coord at(static_cast<int>(random() % 60) - 13, static_cast<int>(random() % 40) + 5,
                       static_cast<int>(random() % 30) - 21);
        if (i % 5 == 0) {
            grid->tree().setValueOff(at, value(random));
        } else {
            grid->tree().setValue(at, value(random));
        }
    }
    grid->tree().addTile(1, Coord(16, 16, -16), 0.75F, true);
    grid->tree().addTile(1, Coord(24, 16, -16), 0.5F, false);
    return grid;
}

/// A dense block of values that `value(x, y, z)` gives, 0 ≤ x, y, z < side.
template <typename Value>
openvdb::FloatGrid::Ptr denseGrid(int side, const Value& value) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    auto accessor = grid->getAccessor();
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < side; ++z) {
                accessor.setValue(openvdb::Coord(x, y, z), static_cast<float>(value(x, y, z)));
            }
        }
    }
    return grid;
}

}  // namespace bandvox::summary_grids
