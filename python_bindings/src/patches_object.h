#pragma once

#include <bandvox/source/bezier_patch.h>

#include <pybind11/pybind11.h>

#include <string>

namespace bandvox::python {

/// Bézier patches of Python.
struct PatchesObject {
    PatchModel model;
    std::string name = "patches";
};

void bindPatches(pybind11::module_& module);

}  // namespace bandvox::python
