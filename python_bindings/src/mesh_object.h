#pragma once

#include <bandvox/mesh/surface_mesh.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace bandvox::python {

/// A mesh of Python: one that may have normals and colours.
struct MeshObject {
    SurfaceMesh surface;
    std::string name = "mesh";
};

void bindMesh(pybind11::module_& module);

}  // namespace bandvox::python
