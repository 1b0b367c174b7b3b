#pragma once

#include <bandvox/render/camera.h>

#include <string>

namespace bandvox::app {

/// The view of a camera in a .gltf or .glb file; `file` may go on with a colon and the name of the
/// camera or of its node, else it is the first that a node has. `aspect`: height of the picture
/// over its width. What the camera's picture shows is as high as in the picture. Throws
/// Error(ErrorKind::Input) if there is none.
CameraOptions readGltfCamera(const std::string& file, double aspect);

}  // namespace bandvox::app
