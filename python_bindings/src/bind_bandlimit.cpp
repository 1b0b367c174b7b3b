// Solids to band-limited densities, by whichever route fits.

#include "arrays.h"
#include "background.h"
#include "callable_field.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "mesh_object.h"
#include "solid_mesh.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/shapes.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

/// The keyword arguments of bandlimit.
struct BandlimitRequest {
    DensityOptions density;
    std::string route;
    bool isUnion = true;
    std::optional<int> oversample;
    py::object bounds;
    int threads = 0;
    py::object progress;
};

DensityResult densityOfMesh(const std::string& name, Mesh mesh, const BandlimitRequest& request,
                            Progress& progress) {
    const Capping capping = request.route == "exact"     ? Capping::All
                            : request.route == "winding" ? Capping::None
                                                         : Capping::Sensible;
    SolidMesh solid = solidOf(std::move(mesh), capping, request.isUnion, progress);
    ClosedMesh& closed = solid.closed;
    DensityResult result;
    if (closed.soup.triangles.empty()) {
        result =
            surfaceToDensity(MeshSource(name, std::move(closed.mesh)), request.density, progress);
    } else {
        SoupDensityOptions options;
        options.density = request.density;
        options.rowsPerVoxel = request.oversample.value_or(options.rowsPerVoxel);
        result = soupToDensity({name, std::move(closed.soup), std::move(closed.mesh)}, options,
                               progress);
    }
    result.metadata.holesCapped = static_cast<int>(closed.report.holes.size());
    setDensityMetadata(*result.grid, result.metadata);
    result.warnings.insert(result.warnings.begin(), solid.warnings.begin(), solid.warnings.end());
    return result;
}

DensityResult densityOfField(const FieldSource& field, const BandlimitRequest& request,
                             Progress& progress) {
    FieldDensityOptions options;
    options.density = request.density;
    options.oversample = request.oversample.value_or(options.oversample);
    return fieldToDensity(field, options, progress);
}

py::object finished(DensityResult&& result) {
    warn(result.warnings);
    return objectOf(result.grid);
}

py::object ofShape(const std::string& shape, const BandlimitRequest& request) {
    return finished(inBackground(request.progress, request.threads, [&](Progress& progress) {
        if (request.route == "sampled") {
            return densityOfField(*makeShapeField(shape), request, progress);
        }
        return surfaceToDensity(*makeShapeBoundary(shape), request.density, progress);
    }));
}

py::object ofFile(const std::filesystem::path& path, const BandlimitRequest& request) {
    return finished(inBackground(request.progress, request.threads, [&](Progress& progress) {
        MeshFile file = readMesh(path, progress);
        DensityResult result =
            densityOfMesh(path.filename().string(), std::move(file.mesh), request, progress);
        result.warnings.insert(result.warnings.begin(), file.warnings.begin(), file.warnings.end());
        return result;
    }));
}

py::object ofMesh(const MeshObject& mesh, const BandlimitRequest& request) {
    return finished(inBackground(request.progress, request.threads, [&](Progress& progress) {
        return densityOfMesh(mesh.name, mesh.surface.mesh, request, progress);
    }));
}

py::object ofFunction(const py::object& function, const BandlimitRequest& request) {
    const openvdb::BBoxd box = boundsOfFunction(request.bounds);
    const CallableField field(function, box);
    try {
        return finished(inBackground(request.progress, request.threads, [&](Progress& progress) {
            return densityOfField(field, request, progress);
        }));
    } catch (const Error&) {
        field.rethrow();
        throw;
    }
}

py::object bandlimit(const py::object& source, const BandlimitRequest& request) {
    if (isPath(source)) {
        const auto path = source.cast<std::filesystem::path>();
        if (isShape(path.string())) return ofShape(path.string(), request);
        return ofFile(path, request);
    }
    if (const auto mesh = meshOf(source)) return ofMesh(*mesh, request);
    if (PyCallable_Check(source.ptr()) != 0) return ofFunction(source, request);
    throw Error(ErrorKind::Usage,
                std::string("found a ") + Py_TYPE(source.ptr())->tp_name +
                    "; expected a file, 'shape:NAME', a Mesh, (points, triangles) or a function");
}

}  // namespace

void bindBandlimit(py::module_& module) {
    const DensityOptions standard;
    module.def(
        "bandlimit",
        [](const py::object& source, int resolution, double voxelSize, double cutoff, double order,
           double tolerance, int tile, bool clamp, double iso, const std::string& route,
           const std::string& overlap, std::optional<int> oversample, const py::object& bounds,
           int threads, const py::object& progress) {
            BandlimitRequest request;
            DensityOptions& density = request.density;
            density.resolution = resolution;
            density.voxelSize = voxelSize;
            density.filter = ExponentialFilter{order, cutoff};
            density.tolerance = tolerance;
            density.tile = tile;
            density.clamp = clamp;
            density.iso = iso;
            choiceOf(route, {"auto", "exact", "sampled", "winding"}, "route");
            request.route = route;
            request.isUnion = choiceOf(overlap, {"union", "sum"}, "overlap") == 0;
            density.sumOverlaps = !request.isUnion;
            request.oversample = oversample;
            request.bounds = bounds;
            request.threads = threads;
            request.progress = progress;
            return bandlimit(source, request);
        },
        py::arg("source"), py::kw_only(), py::arg("resolution") = standard.resolution,
        py::arg("voxel_size") = 0.0, py::arg("cutoff") = standard.filter.cutoff,
        py::arg("order") = standard.filter.order, py::arg("tolerance") = standard.tolerance,
        py::arg("tile") = 0, py::arg("clamp") = false, py::arg("iso") = standard.iso,
        py::arg("route") = "auto", py::arg("overlap") = "union", py::arg("oversample") = py::none(),
        py::arg("bounds") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
        R"(Turns a solid into a band-limited density: 1 inside, 0 outside, and in between only what
the grid can hold.

source: a mesh file, 'shape:NAME', a Mesh, (points, triangles), or a function f(x, y, z) of arrays
with bounds, its values 0 outside of them. resolution: voxels along the longest side; voxel_size:
world units, instead. cutoff (cycles per voxel, 0.01 to 0.5) and order (1 to 64) of the filter
exp(-(k/cutoff)**order). tolerance: error of the density allowed, 1e-6 to 0.05. tile: side of the
cube filtered at a time, voxels; 0 chooses. clamp: limit the density to 0 .. 1. iso: the value that
is the surface. route: 'auto', 'exact', 'sampled' (shapes, functions) or 'winding' (meshes with
openings). overlap: 'union' or 'sum' of a mesh's shells. oversample: samples along a voxel's side,
or rows of the winding number. threads: 0 for all. progress: called as progress(stage, fraction or
None).

What was measured is in the grid's metadata. Raises UsageError, InputError, ResultError,
OutOfMemoryError; warns by BandvoxWarning.)");
    module.def("shape_names", &shapeNames, "Names of the built-in shapes.");
}

}  // namespace bandvox::python
