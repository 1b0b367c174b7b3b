#pragma once

#include <bandvox/render/camera.h>

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

namespace bandvox::python {

/// Three numbers, or nothing for None.
std::optional<openvdb::Vec3d> optionalVectorOf(const pybind11::handle& object, const char* what);

/// A view as Python's functions take it. None: chosen so that the object fits, or as the camera's
/// file says.
struct CameraArguments {
    pybind11::object eye, lookat, up, from;
    pybind11::object camera;  ///< "perspective" or "orthographic"
    pybind11::object file;    ///< of glTF; may go on with a colon and a name
    std::optional<double> focal, aperture, fov, frame;
};

/// `aspect`: height of the picture over its width. Throws Error(ErrorKind::Usage) for what is no
/// view, Error(ErrorKind::Input) for a file without a camera.
CameraOptions cameraOf(const CameraArguments& arguments, double aspect);

/// Throws Error(ErrorKind::Usage) for arguments that change nothing: a lens of a parallel view, a
/// direction to an eye that is given.
void requireUsed(const CameraArguments& arguments, const CameraOptions& options);

}  // namespace bandvox::python
