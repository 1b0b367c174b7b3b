#pragma once

#include <pybind11/pybind11.h>

// What each file adds to the module.
namespace bandvox::python {

void bindArrays(pybind11::module_& module);
void bindBandlimit(pybind11::module_& module);
void bindCompare(pybind11::module_& module);
void bindFit(pybind11::module_& module);
void bindFitVolume(pybind11::module_& module);
void bindGridFiles(pybind11::module_& module);
void bindGridSolids(pybind11::module_& module);
void bindOutline(pybind11::module_& module);
void bindPoints(pybind11::module_& module);
void bindReconstruction(pybind11::module_& module);
void bindRender(pybind11::module_& module);
void bindReports(pybind11::module_& module);
void bindResample(pybind11::module_& module);
void bindVoxelize(pybind11::module_& module);

}  // namespace bandvox::python
