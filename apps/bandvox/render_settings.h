#pragma once

#include "option_table.h"
#include "option_values.h"

#include <bandvox/render/image.h>
#include <bandvox/render/picture_options.h>

#include <vector>

namespace bandvox::app {

/// The options of `render` that are about the picture and the camera, not about what is seen.
std::vector<OptionEntry> pictureEntries();

/// Those of them that are about the camera.
std::vector<OptionEntry> cameraEntries();

/// Reads those. `aspect`: height of the picture over its width, for what a file with a camera says.
/// Throws as readPictureOptions does.
CameraOptions readCamera(const OptionValues& values, double aspect);

/// Throws Error(ErrorKind::Usage) for options of the camera that change nothing: a lens of a
/// parallel view, a direction to an eye that is given.
void requireUsedCamera(const OptionValues& values, const CameraOptions& camera);

/// Reads all. Throws Error(ErrorKind::Usage), and Error(ErrorKind::Input) for a file with a camera
/// that cannot be used.
PictureOptions readPictureOptions(const OptionValues& values);

/// What an .exr is to hold.
ImageChannels readChannels(const OptionValues& values);

}  // namespace bandvox::app
