#pragma once

#include "mesh_object.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/close_mesh.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace bandvox::python {

/// A mesh of which a solid can be made, and what a user should know of it.
struct SolidMesh {
    ClosedMesh closed;
    std::vector<std::string> warnings;
};

/// Closes a mesh and, if `isUnion`, makes shells that overlap one.
SolidMesh solidOf(Mesh mesh, Capping capping, bool isUnion, Progress& progress);

/// The mesh that a Mesh or a pair (points, triangles) is; null for anything else. Throws
/// Error(ErrorKind::Usage) for pairs of other arrays.
std::shared_ptr<const MeshObject> meshOf(const pybind11::object& source);

}  // namespace bandvox::python
