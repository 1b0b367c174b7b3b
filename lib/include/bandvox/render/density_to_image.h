#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/render/camera.h>
#include <bandvox/render/image.h>
#include <bandvox/render/shading.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <optional>

namespace bandvox {

/// How a density is drawn.
struct RenderOptions {
    int width = 1024;   ///< pixels; 1 to 65536
    int height = 1024;  ///< pixels; 1 to 65536
    int samples = 1;    ///< lines of sight per pixel, on a regular grid; ≥ 1
    CameraOptions camera;
    Shading shading = Shading::Spectral;  ///< where normals come from
    std::optional<double> iso;  ///< default: what the grid's metadata says, else 0.5, or 0 of a
                                ///< level set
    openvdb::Vec3d light{-0.4, 0.7, 0.8};  ///< towards the light, in camera axes (right, up, back)
    openvdb::Vec3d color{0.8, 0.8, 0.8};   ///< linear, of the surface
    double ambient = 0.1;                  ///< light from everywhere, 0 to 1
    bool allowEmpty = false;               ///< let nothing be seen, instead of throwing
    std::optional<openvdb::Vec3d> background;  ///< linear; default: transparent
};

/// Throws Error(ErrorKind::Usage) for options out of range, as far as that does not depend on a
/// grid.
void requireValid(const RenderOptions& options);

/// A picture and what it took.
struct RenderResult {
    Image image;
    std::int64_t rays = 0;
    std::int64_t hits = 0;
};

/// Draws the surface {density = iso} with Lambert shading. Each line of sight is bracketed on
/// the grid and refined on the band-limited reconstruction; the normal is its gradient. Grids that
/// this library has not made are read by the cubic spline through their values; of a level set
/// (its class says so), inside is below iso, world units. Voxels may have any linear transform.
/// With another Shading, lines of sight end at the faces of voxels instead; Shading::Depth leaves
/// the picture's normals 0.
///
/// Figure 7 and section 3.2 of Chiba, Aoki, Saito (1990), with signed frequencies.
/// Throws Error(ErrorKind::Usage) for options out of range, Error(ErrorKind::Input) if the grid
/// has no active voxel or bends lines of sight, holds values that are not finite or a stored
/// iso-value that is not above its background, Error(ErrorKind::Result) if nothing is seen
/// and that is not allowed.
RenderResult densityToImage(const openvdb::FloatGrid::ConstPtr& grid,
                            const RenderOptions& options = {},
                            Progress& progress = silentProgress());

}  // namespace bandvox
