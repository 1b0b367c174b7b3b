#pragma once

#include <pybind11/pybind11.h>

// What each file adds to the module.
namespace bandvox::python {

void bindBandlimit(pybind11::module_& module);
void bindRender(pybind11::module_& module);
void bindOperations(pybind11::module_& module);
void bindOutline(pybind11::module_& module);
void bindFit(pybind11::module_& module);
void bindFitVolume(pybind11::module_& module);
void bindVoxelize(pybind11::module_& module);

}  // namespace bandvox::python
