#include "camera_arguments.h"

#include "arrays.h"
#include "choices.h"

namespace bandvox::python {

std::optional<openvdb::Vec3d> optionalVectorOf(const pybind11::object& object, const char* what) {
    if (object.is_none()) return std::nullopt;
    return vectorOf(object, what);
}

CameraOptions cameraOf(const CameraArguments& arguments) {
    CameraOptions options;
    options.eye = optionalVectorOf(arguments.eye, "eye");
    options.lookat = optionalVectorOf(arguments.lookat, "lookat");
    options.up = optionalVectorOf(arguments.up, "up");
    if (!arguments.from.is_none()) options.from = vectorOf(arguments.from, "from_");
    options.projection = static_cast<CameraOptions::Projection>(
        choiceOf(arguments.camera, {"perspective", "orthographic"}, "camera"));
    options.focal = arguments.focal;
    options.aperture = arguments.aperture;
    options.frame = arguments.frame;
    requireValid(options);
    return options;
}

}  // namespace bandvox::python
