// Bézier patches: from files and control nets, and back.

#include "arrays.h"
#include "background.h"
#include "errors.h"
#include "patches_object.h"

#include <bandvox/source/bspline_patch.h>
#include <bandvox/source/read_patches.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <memory>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using Shared = std::shared_ptr<PatchesObject>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Control points, (u, v, 3) or homogeneous ones (u, v, 4), as (w x, w y, w z, w).
std::vector<std::array<double, 4>> controlOf(const py::handle& object, std::array<int, 2>& count) {
    const std::string expected =
        "finite numbers of shape (u, v, 3), or (u, v, 4) as (w x, w y, w z, w) with w above 0";
    const auto numbers = Doubles::ensure(numericArray(object, "control points", expected));
    const bool fits = numbers.ndim() == 3 && (numbers.shape(2) == 3 || numbers.shape(2) == 4) &&
                      numbers.shape(0) > 1 && numbers.shape(1) > 1;
    const auto fail = [&](const std::string& found) {
        throw Error(ErrorKind::Usage, "control points: found " + found + "; expected " + expected);
    };
    if (!fits) fail(described(numbers));
    count = {static_cast<int>(numbers.shape(0)), static_cast<int>(numbers.shape(1))};
    const auto width = static_cast<std::size_t>(numbers.shape(2));
    std::vector<std::array<double, 4>> control(static_cast<std::size_t>(numbers.size()) / width);
    for (std::size_t i = 0; i < control.size(); ++i) {
        control[i] = {0, 0, 0, 1};
        for (std::size_t k = 0; k < width; ++k) {
            control[i][k] = numbers.data()[width * i + k];
            if (!std::isfinite(control[i][k])) fail(std::to_string(control[i][k]));
        }
        if (!(control[i][3] > 0)) fail("the weight " + std::to_string(control[i][3]));
    }
    return control;
}

Shared patchesOfNets(const py::iterable& nets, const py::object& objects) {
    auto result = std::make_shared<PatchesObject>();
    for (const py::handle net : nets) {
        std::array<int, 2> count{};
        BezierPatch patch;
        patch.control = controlOf(net, count);
        patch.degreeU = count[0] - 1;
        patch.degreeV = count[1] - 1;
        if (std::max(patch.degreeU, patch.degreeV) > BezierPatch::kHighestDegree) {
            throw Error(ErrorKind::Usage, "control points: found " + std::to_string(count[0]) +
                                              " x " + std::to_string(count[1]) +
                                              " of a patch; expected 26 x 26 at most");
        }
        result->model.patches.push_back(std::move(patch));
    }
    auto& model = result->model;
    if (model.patches.empty()) {
        throw Error(ErrorKind::Usage, "found no control net; expected one for each patch");
    }
    if (objects.is_none()) {
        model.objects = {"patches"};
        return result;
    }
    const auto names = objects.cast<std::vector<std::string>>();
    if (names.size() != model.patches.size()) {
        throw Error(ErrorKind::Usage, "objects: found " + std::to_string(names.size()) +
                                          " names; expected one for each of " +
                                          std::to_string(model.patches.size()) + " patches");
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto known = std::find(model.objects.begin(), model.objects.end(), names[i]);
        model.patches[i].object = static_cast<int>(known - model.objects.begin());
        if (known == model.objects.end()) model.objects.push_back(names[i]);
    }
    return result;
}

Shared patchesOfBspline(const py::handle& control, std::vector<double> knotsU,
                        std::vector<double> knotsV) {
    BsplineNet net;
    net.control = controlOf(control, net.count);
    net.knots = {std::move(knotsU), std::move(knotsV)};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        net.degree[axis] = static_cast<int>(net.knots[axis].size()) - net.count[axis] - 1;
    }
    auto result = std::make_shared<PatchesObject>();
    result->model = {bezierPatches(net), {"patches"}, {}};
    return result;
}

Shared readPatchesObject(const std::filesystem::path& path) {
    auto result = std::make_shared<PatchesObject>();
    result->model = inBackground(py::none(), 0,
                                 [&](Progress& progress) { return readPatches(path, progress); });
    result->name = path.filename().string();
    warn(result->model.warnings);
    return result;
}

py::list netsOf(const PatchesObject& patches) {
    py::list nets;
    for (const BezierPatch& patch : patches.model.patches) {
        std::vector<double> numbers;
        numbers.reserve(4 * patch.control.size());
        for (const auto& point : patch.control) {
            numbers.insert(numbers.end(), point.begin(), point.end());
        }
        nets.append(ownedArray(std::move(numbers), {patch.degreeU + 1, patch.degreeV + 1, 4}));
    }
    return nets;
}

std::vector<std::string> objectsOf(const PatchesObject& patches) {
    std::vector<std::string> names;
    for (const BezierPatch& patch : patches.model.patches) {
        names.push_back(patches.model.objects[static_cast<std::size_t>(patch.object)]);
    }
    return names;
}

/// What `visit` gives of each place (u, v) of a patch, three numbers.
template <typename Visit>
py::array evaluated(const PatchesObject& patches, std::size_t index, const py::handle& uv,
                    const Visit& visit) {
    if (index >= patches.model.patches.size()) throw py::index_error("no such patch");
    const std::string expected = "numbers of shape (n, 2), from 0 to 1";
    const auto places = Doubles::ensure(numericArray(uv, "uv", expected));
    if (places.ndim() != 2 || places.shape(1) != 2) {
        throw Error(ErrorKind::Usage, "uv: found " + described(places) + "; expected " + expected);
    }
    const BezierPatch& patch = patches.model.patches[index];
    const auto count = static_cast<std::size_t>(places.shape(0));
    std::vector<double> numbers(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const double u = places.data()[2 * i], v = places.data()[2 * i + 1];
        if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) {
            throw Error(ErrorKind::Usage, "uv: found " + std::to_string(u) + ", " +
                                              std::to_string(v) + "; expected " + expected);
        }
        const std::array<double, 3> found = visit(evaluate(patch, u, v));
        std::copy(found.begin(), found.end(), &numbers[3 * i]);
    }
    return ownedArray(std::move(numbers), {places.shape(0), 3});
}

std::array<double, 3> normalOf(const PatchJet& jet) {
    const openvdb::Vec3d du(jet.du.data()), dv(jet.dv.data());
    const openvdb::Vec3d across = du.cross(dv);
    const double length = across.length();
    if (!(length > 0)) return {0, 0, 0};
    return {across[0] / length, across[1] / length, across[2] / length};
}

}  // namespace

void bindPatches(py::module_& module) {
    py::class_<PatchesObject, Shared>(module, "Patches", R"(Bézier patches, rational or not.

Patches(nets, objects=None): nets: an array for each, of control points (u, v, 3) or of homogeneous
ones (u, v, 4), (w x, w y, w z, w) with w above 0; world units. There are 2 to 26 along u and along
v, one more than the degree. objects: the name of the object that each patch belongs to.)")
        .def(py::init(&patchesOfNets), py::arg("nets"), py::arg("objects") = py::none())
        .def_static("from_bspline", &patchesOfBspline, py::arg("control"), py::arg("knots_u"),
                    py::arg("knots_v"),
                    R"(The patches of a B-spline surface, which are the surface exactly.

control: (u, v, 3), or homogeneous (u, v, 4). knots: as many as control points, the degree and one,
not descending; so their number says what the degree is.)")
        .def_static(
            "read", &readPatchesObject, py::arg("path"),
            R"(Reads Newell's .bpt, the free-form surfaces of an .obj, or a part of a CAD program.

That is a .step, .stp, .iges, .igs or .brep file, where Open CASCADE was built in: patches then are the
surfaces that faces lie on, of which outline draws what belongs to the faces. Raises InputError.)")
        .def_property_readonly("nets", &netsOf,
                               "(u, v, 4) float64 for each: (w x, w y, w z, w), world units.")
        .def_property_readonly("objects", &objectsOf, "The name of each patch's object.")
        .def_readonly("name", &PatchesObject::name, "The file's name, or 'patches'.")
        .def(
            "position",
            [](const PatchesObject& self, std::size_t patch, const py::object& uv) {
                return evaluated(self, patch, uv, [](const PatchJet& jet) { return jet.position; });
            },
            py::arg("patch"), py::arg("uv"),
            "(n, 3) float64: points of a patch at parameters (n, 2), from 0 to 1.")
        .def(
            "normal",
            [](const PatchesObject& self, std::size_t patch, const py::object& uv) {
                return evaluated(self, patch, uv, &normalOf);
            },
            py::arg("patch"), py::arg("uv"),
            "(n, 3) float64: du x dv there, of length 1; 0 where there is none.")
        .def("__len__", [](const PatchesObject& self) { return self.model.patches.size(); })
        .def("__repr__", [](const PatchesObject& self) {
            return "<bandvox.Patches '" + self.name +
                   "': " + std::to_string(self.model.patches.size()) + " patches>";
        });
}

}  // namespace bandvox::python
