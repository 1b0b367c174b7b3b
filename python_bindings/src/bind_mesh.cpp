// Triangle meshes, from files and from arrays.

#include "arrays.h"
#include "background.h"
#include "errors.h"
#include "mesh_object.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/source/read_mesh.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using openvdb::Vec3d;

std::shared_ptr<MeshObject> meshOfArrays(const py::handle& points, const py::handle& triangles,
                                         const py::object& colors) {
    auto mesh = std::make_shared<MeshObject>();
    mesh->surface.mesh.points = vectorsOf(points, "points");
    mesh->surface.mesh.triangles = indicesOf(triangles, "triangles");
    const std::size_t count = mesh->surface.mesh.points.size();
    for (const openvdb::Vec3I& t : mesh->surface.mesh.triangles) {
        const std::size_t largest = std::max({t[0], t[1], t[2]});
        if (largest < count) continue;
        throw Error(ErrorKind::Usage, "triangles: found the point " + std::to_string(largest) +
                                          "; expected less than the number of points, " +
                                          std::to_string(count));
    }
    if (colors.is_none()) return mesh;
    for (const Vec3d& color : vectorsOf(colors, "colors")) {
        const auto [least, most] = std::minmax({color[0], color[1], color[2]});
        if (!(least >= 0 && most <= 1)) {
            throw Error(ErrorKind::Usage, "colors: expected linear light from 0 to 1");
        }
        mesh->surface.colors.emplace_back(color);
    }
    if (mesh->surface.colors.size() != count) {
        throw Error(ErrorKind::Usage,
                    "colors: found " + std::to_string(mesh->surface.colors.size()) +
                        "; expected one for each of " + std::to_string(count) + " points");
    }
    return mesh;
}

py::tuple stateOf(const py::object& self) {
    return py::make_tuple(self.attr("points"), self.attr("triangles"), self.attr("normals"),
                          self.attr("colors"), self.attr("name"));
}

std::shared_ptr<MeshObject> meshOfState(const py::tuple& state) {
    if (state.size() != 5) throw Error(ErrorKind::Input, "the pickle holds no mesh");
    auto mesh = meshOfArrays(state[0], state[1], state[3]);
    if (!state[2].is_none()) {
        for (const Vec3d& normal : vectorsOf(state[2], "normals")) {
            mesh->surface.normals.emplace_back(normal);
        }
    }
    mesh->name = state[4].cast<std::string>();
    return mesh;
}

std::shared_ptr<MeshObject> readMeshObject(const std::filesystem::path& path) {
    MeshFile file =
        inBackground(py::none(), 0, [&](Progress& progress) { return readMesh(path, progress); });
    warn(file.warnings);
    auto mesh = std::make_shared<MeshObject>();
    mesh->surface.mesh = std::move(file.mesh);
    mesh->name = path.filename().string();
    return mesh;
}

/// Those of points are the mean of their triangles', weighted by area.
std::vector<openvdb::Vec3f> normalsOf(const Mesh& mesh) {
    std::vector<Vec3d> sums(mesh.points.size(), Vec3d(0.0));
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d& a = mesh.points[t[0]];
        const Vec3d area = (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
        for (int k = 0; k < 3; ++k) sums[t[k]] += area;
    }
    std::vector<openvdb::Vec3f> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double length = sums[i].length();
        normals[i] = length > 0 ? openvdb::Vec3f(sums[i] / length) : openvdb::Vec3f(0, 0, 1);
    }
    return normals;
}

void writeMeshObject(const MeshObject& mesh, const std::filesystem::path& path) {
    const auto write = [&](Progress& progress) {
        SurfaceMesh surface = mesh.surface;
        if (surface.normals.empty()) surface.normals = normalsOf(surface.mesh);
        AtomicFile file(path);
        writeMesh(file, surface, progress);
        file.commit();
    };
    runInBackground(write, py::none(), 0);
}

template <typename Vector>
py::object viewOrNone(const std::vector<Vector>& vectors, const py::handle& owner) {
    if (vectors.empty()) return py::none();
    return viewOf(vectors, owner);
}

}  // namespace

void bindMesh(py::module_& module) {
    using Shared = std::shared_ptr<MeshObject>;
    py::class_<MeshObject, Shared>(module, "Mesh", R"(Triangles over shared points.

Mesh(points, triangles, colors=None): points of shape (n, 3), world units; triangles of shape (m, 3), indices
of points, counter-clockwise from outside; colors of shape (n, 3), linear light, 0 to 1. Arrays are copied.)")
        .def(py::init(&meshOfArrays), py::arg("points"), py::arg("triangles"),
             py::arg("colors") = py::none())
        .def_static("read", &readMeshObject, py::arg("path"),
                    "Reads .obj, .ply, .stl, .off, .gltf, .glb, .fbx or .dae, all objects of it. "
                    "Raises InputError for files that are none.")
        .def_property_readonly(
            "points",
            [](const py::object& self) {
                return viewOf(self.cast<const MeshObject&>().surface.mesh.points, self);
            },
            "(n, 3) float64, world units; read-only, not copied.")
        .def_property_readonly(
            "triangles",
            [](const py::object& self) {
                return viewOf(self.cast<const MeshObject&>().surface.mesh.triangles, self);
            },
            "(m, 3) uint32; read-only, not copied.")
        .def_property_readonly(
            "normals",
            [](const py::object& self) {
                return viewOrNone(self.cast<const MeshObject&>().surface.normals, self);
            },
            "(n, 3) float32, unit; None if the mesh has none.")
        .def_property_readonly(
            "colors",
            [](const py::object& self) {
                return viewOrNone(self.cast<const MeshObject&>().surface.colors, self);
            },
            "(n, 3) float32, linear light; None if the mesh has none.")
        .def_readonly("name", &MeshObject::name, "The file's name, or 'mesh'.")
        .def("write", &writeMeshObject, py::arg("path"),
             "Writes .obj, .ply, .stl, .gltf or .glb, whole or not at all.")
        .def(py::pickle(&stateOf, &meshOfState))
        .def("__repr__", [](const MeshObject& mesh) {
            return "<bandvox.Mesh '" + mesh.name +
                   "': " + std::to_string(mesh.surface.mesh.points.size()) + " points, " +
                   std::to_string(mesh.surface.mesh.triangles.size()) + " triangles>";
        });
}

}  // namespace bandvox::python
