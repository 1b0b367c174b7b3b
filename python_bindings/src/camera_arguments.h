#pragma once

#include <bandvox/render/camera.h>

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

namespace bandvox::python {

/// Three numbers, or nothing for None.
std::optional<openvdb::Vec3d> optionalVectorOf(const pybind11::object& object, const char* what);

/// A view as Python's functions take it. None: chosen so that the object fits.
struct CameraArguments {
    pybind11::object eye, lookat, up, from;
    std::string camera;  ///< "perspective" or "orthographic"
    double focal, aperture, frame;
};

/// Throws Error(ErrorKind::Usage) for what is no view.
CameraOptions cameraOf(const CameraArguments& arguments);

}  // namespace bandvox::python
