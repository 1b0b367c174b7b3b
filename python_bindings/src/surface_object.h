#pragma once

#include <bandvox/scatter/fit_surface.h>
#include <bandvox/source/colored_mesh.h>

#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace bandvox::python {

/// A fitted surface of Python: the sum of some of its levels.
struct SurfaceObject {
    std::shared_ptr<const SurfaceFit> fit;
    BsplineSurface surface;
    std::string name = "points";
    std::vector<std::string> columns;  ///< their names; empty of arrays
};

using SharedSurface = std::shared_ptr<SurfaceObject>;

/// The sum of the levels from the first to the last, as counted from 1. Throws
/// Error(ErrorKind::Usage) if they are not there.
BsplineSurface sumOf(const SurfaceFit& fit, const std::array<int, 2>& levels);

/// Samples along x and y, so many along the longer side, as far apart along both. Throws
/// Error(ErrorKind::Usage) unless there are 2 to 32768.
std::array<int, 2> sampleCounts(const BsplineSurface& surface, int longer);

/// The surface with the colours of its columns named r, g and b, with a sample for each voxel.
/// Throws Error(ErrorKind::Usage) without them.
ColoredMesh coloredSurface(const SurfaceObject& surface, double voxelSize);

void bindSurface(pybind11::module_& module);

}  // namespace bandvox::python
