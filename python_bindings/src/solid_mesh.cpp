#include "solid_mesh.h"

#include "arrays.h"
#include "paths.h"

#include <bandvox/source/unite_shells.h>

namespace bandvox::python {

namespace py = pybind11;

SolidMesh solidOf(Mesh mesh, Capping capping, bool isUnion, Progress& progress) {
    SolidMesh solid{closeMesh(std::move(mesh), {.capping = capping}, progress), {}};
    solid.warnings = solid.closed.report.warnings;
    if (isUnion && !solid.closed.mesh.triangles.empty()) {
        UnitedMesh united = uniteShells(std::move(solid.closed.mesh), progress);
        solid.closed.mesh = std::move(united.mesh);
        solid.warnings.insert(solid.warnings.end(), united.report.warnings.begin(),
                              united.report.warnings.end());
    }
    return solid;
}

std::shared_ptr<const MeshObject> meshOf(const py::object& source) {
    if (py::isinstance<MeshObject>(source)) {
        return source.cast<std::shared_ptr<MeshObject>>();
    }
    if (isPath(source) || !py::isinstance<py::sequence>(source) || py::len(source) != 2) {
        return nullptr;
    }
    const auto arrays = source.cast<py::sequence>();
    auto mesh = std::make_shared<MeshObject>();
    mesh->surface.mesh = {vectorsOf(arrays[0], "points"), indicesOf(arrays[1], "triangles")};
    return mesh;
}

}  // namespace bandvox::python
