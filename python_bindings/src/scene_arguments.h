#pragma once

#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>

#include <pybind11/pybind11.h>

namespace bandvox::python {

/// What is to be seen: "objects", "lights" and "environment", as the package's module scene.py has
/// them. Throws Error(ErrorKind::Usage) for what is out of range, Error(ErrorKind::Input) for an
/// image that cannot be read.
Scene sceneOf(const pybind11::dict& arguments);

/// How it is drawn, with the names of the options of `render`. Throws as sceneOf.
PictureOptions pictureOptionsOf(const pybind11::dict& arguments);

}  // namespace bandvox::python
