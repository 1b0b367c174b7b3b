#pragma once

#include <bandvox/scatter/fit_surface.h>

#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <string>

namespace bandvox::python {

/// A fitted surface of Python: the sum of some of its levels.
struct SurfaceObject {
    std::shared_ptr<const SurfaceFit> fit;
    BsplineSurface surface;
    std::string name = "points";
};

using SharedSurface = std::shared_ptr<SurfaceObject>;

/// The sum of the levels from the first to the last, as counted from 1. Throws
/// Error(ErrorKind::Usage) if they are not there.
BsplineSurface sumOf(const SurfaceFit& fit, const std::array<int, 2>& levels);

void bindSurface(pybind11::module_& module);

}  // namespace bandvox::python
