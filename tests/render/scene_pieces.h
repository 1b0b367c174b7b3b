#pragma once

#include "render/ball_scene.h"

#include <bandvox/render/scene_to_image.h>

#include <openvdb/openvdb.h>

// Solids and pictures of them whose light has a closed form.
namespace bandvox::render_test {

/// The density at a distance from a flat face, outside positive, voxels: under the default filter.
double faceDensity(double distance);

/// A box under the default filter, index coordinates; its faces are where the density is 0.5.
openvdb::FloatGrid::Ptr boxGrid(const openvdb::BBoxd& box);

/// The ball of ballGrid() moved so that its middle is there; a voxel is one world unit.
openvdb::FloatGrid::Ptr ballAt(const openvdb::Vec3d& middle);

/// A surface of this material.
SceneObject surfaceOf(const openvdb::FloatGrid::ConstPtr& grid, const Material& material);

/// Light of 1 from everywhere, which is not seen itself.
Environment furnace();

/// A square orthographic picture, `frame` world units wide, of `lookat` from 100 units away in a
/// direction.
PictureOptions pictureFrom(const openvdb::Vec3d& direction, const openvdb::Vec3d& lookat, int side,
                           double frame);

/// R, G, B of a pixel.
openvdb::Vec3d colorAt(const Image& image, int column, int row);

}  // namespace bandvox::render_test
