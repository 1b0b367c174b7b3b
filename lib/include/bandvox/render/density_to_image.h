#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>
#include <bandvox/render/shading.h>

#include <openvdb/openvdb.h>

#include <optional>

namespace bandvox {

/// How a density is drawn.
struct RenderOptions : PictureOptions {
    Shading shading = Shading::Spectral;  ///< where normals come from
    std::optional<double> iso;  ///< default: what the grid's metadata says, else 0.5, or 0 of a
                                ///< level set
    openvdb::Vec3d light{-0.4, 0.7, 0.8};  ///< towards the light, in camera axes (right, up, back)
    openvdb::Vec3d color{0.8, 0.8, 0.8};   ///< linear, of the surface
    double ambient = 0.1;                  ///< light from everywhere, 0 to 1
};

/// Throws Error(ErrorKind::Usage) for options out of range, as far as that does not depend on a
/// grid.
void requireValid(const RenderOptions& options);

/// The scene that these options make of a grid: a matt surface, a distant light of brightness
/// 1 - ambient, and ambient light.
Scene sceneOf(const openvdb::FloatGrid::ConstPtr& grid, const RenderOptions& options);

/// Draws the surface {density = iso} of one grid with Lambert shading, as sceneToImage draws
/// sceneOf(grid, options). Of a level set (its class says so), inside is below iso, world units.
/// Voxels may have any linear transform. With another Shading, lines of sight end at the faces of
/// voxels instead, and light is not followed any farther; Shading::Depth leaves the picture's
/// normals 0.
///
/// Throws Error(ErrorKind::Usage) for options out of range, Error(ErrorKind::Input) if the grid
/// has no active voxel or bends lines of sight, holds values that are not finite or a stored
/// iso-value that is not above its background, Error(ErrorKind::Result) if nothing is seen
/// and that is not allowed.
RenderResult densityToImage(const openvdb::FloatGrid::ConstPtr& grid,
                            const RenderOptions& options = {},
                            Progress& progress = silentProgress());

}  // namespace bandvox
