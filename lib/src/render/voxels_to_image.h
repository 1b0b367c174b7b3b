#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/render/camera.h>
#include <bandvox/render/density_to_image.h>

#include <openvdb/openvdb.h>

namespace bandvox {

/// A grid as cubes: solid where its value is at least `iso`, which is above its background.
struct VoxelScene {
    const openvdb::FloatGrid& grid;
    double iso;
    const Camera& camera;
    const RenderOptions& options;  ///< valid; the shading is not Shading::Spectral
};

/// Draws the voxels of a scene by one of the older methods. Throws Error(ErrorKind::Result) if
/// nothing is seen, Error(ErrorKind::Memory) before allocating if the picture would not fit,
/// Error(ErrorKind::Interrupted).
///
/// The lines of sight through one place in each pixel make a picture of their own, with its own
/// depth buffer; those of several samples per pixel are added up.
RenderResult voxelsToImage(const VoxelScene& scene, Progress& progress);

}  // namespace bandvox
