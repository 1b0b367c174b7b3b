#include "camera_arguments.h"

#include "arrays.h"
#include "choices.h"
#include "paths.h"

#include <gltf_camera.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace bandvox::python {

std::optional<openvdb::Vec3d> optionalVectorOf(const pybind11::handle& object, const char* what) {
    if (object.is_none()) return std::nullopt;
    return vectorOf(object, what);
}

CameraOptions cameraOf(const CameraArguments& arguments, double aspect) {
    CameraOptions options;
    if (!arguments.file.is_none()) {
        const auto file = pathOf(arguments.file);
        options = app::readGltfCamera(file.string(), aspect);
    }
    if (const auto eye = optionalVectorOf(arguments.eye, "eye")) options.eye = eye;
    if (const auto lookat = optionalVectorOf(arguments.lookat, "lookat")) options.lookat = lookat;
    if (const auto up = optionalVectorOf(arguments.up, "up")) options.up = up;
    options.from = optionalVectorOf(arguments.from, "from_").value_or(options.from);
    if (!arguments.camera.is_none()) {
        options.projection = static_cast<CameraOptions::Projection>(choiceOf(
            arguments.camera.cast<std::string>(), {"perspective", "orthographic"}, "camera"));
    }
    options.aperture = arguments.aperture.value_or(options.aperture);
    options.focal = arguments.focal.value_or(options.focal);
    if (arguments.frame.value_or(0) != 0 &&
        options.projection != CameraOptions::Projection::Orthographic) {
        throw Error(ErrorKind::Usage,
                    "frame is the width of an orthographic view; expected "
                    "camera='orthographic' beside it");
    }
    options.frame = arguments.frame.value_or(options.frame);
    if (arguments.fov) {
        const double degrees = *arguments.fov;
        if (arguments.focal || !(degrees > 0 && degrees < 180)) {
            throw Error(ErrorKind::Usage,
                        "fov is " + std::to_string(degrees) +
                            "; expected degrees above 0 and below 180, and no focal with it");
        }
        options.focal = 0.5 * options.aperture / std::tan(degrees / 2 * std::numbers::pi / 180);
    }
    requireValid(options);
    return options;
}

void requireUsed(const CameraArguments& arguments, const CameraOptions& options) {
    if (!arguments.from.is_none() && options.eye) {
        throw Error(
            ErrorKind::Usage,
            "from_ is the direction to an eye that is chosen, and an eye is given; expected "
            "one of the two");
    }
    const bool hasLens = arguments.focal || arguments.aperture || arguments.fov;
    if (hasLens && options.projection == CameraOptions::Projection::Orthographic) {
        throw Error(ErrorKind::Usage,
                    "focal, aperture and fov are for a perspective view; expected frame, the width "
                    "of an orthographic one, or camera='perspective'");
    }
}

}  // namespace bandvox::python
