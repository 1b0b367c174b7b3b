#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>

#include <vector>

namespace bandvox {

/// Cameras that go once around a scene, about the direction that is up, in even steps; the first is
/// that of the options. All see what they look at from as far away, and as wide, that all of the
/// scene fits in every picture, unless the options say where the eye is.
/// Throws Error(ErrorKind::Usage) unless `pictures` is 1 to 100000, and as sceneToImage;
/// Error(ErrorKind::Interrupted).
std::vector<CameraOptions> turntable(const Scene& scene, const PictureOptions& options,
                                     int pictures, Progress& progress = silentProgress());

}  // namespace bandvox
