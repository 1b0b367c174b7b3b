#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>

namespace bandvox {

/// Draws a scene. Lines of sight are bracketed on the grids and refined on the band-limited
/// reconstruction, whose gradient is the normal; grids that this library has not made are read by
/// the cubic spline through their values. Surfaces are a matt ground under a coat of facets, or
/// glass; light that is scattered in volumes comes straight from the lamps (docs/rendering.md).
///
/// Figure 7 and section 3.2 of N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling"
/// (1990), with signed frequencies. The same for any number of threads.
/// Throws Error(ErrorKind::Usage) for values out of range, Error(ErrorKind::Input) for a grid that
/// cannot be drawn, Error(ErrorKind::Result) if nothing is seen and that is not allowed,
/// Error(ErrorKind::Memory), Error(ErrorKind::Interrupted).
RenderResult sceneToImage(const Scene& scene, const PictureOptions& options = {},
                          Progress& progress = silentProgress());

}  // namespace bandvox
