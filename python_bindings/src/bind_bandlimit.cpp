// Solids to band-limited densities, by whichever route fits.

#include "arrays.h"
#include "bindings.h"
#include "callable_field.h"
#include "choices.h"
#include "density_request.h"
#include "grid_object.h"
#include "mesh_object.h"
#include "patches_object.h"
#include "paths.h"
#include "solid_density.h"
#include "solid_mesh.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/patch_solid.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

const std::vector<std::string> kRoutes{"auto", "exact", "sampled", "winding"};

/// The keyword arguments of bandlimit.
struct BandlimitRequest : DensityRequest {
    std::string route = "auto";
    bool isUnion = true;
    std::optional<int> oversample;
    std::optional<double> base;
    py::object bounds;
};

void addWarnings(const std::vector<std::string>& warnings, DensityResult& result) {
    result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
}

/// Throws unless the route is one of those that a source can take.
void requireRoute(const BandlimitRequest& request, const std::vector<std::string>& allowed,
                  const std::string& source) {
    if (std::find(allowed.begin(), allowed.end(), request.route) != allowed.end()) return;
    std::string message = "route is '" + request.route + "', and the source is " + source;
    message += "; expected one of";
    for (const std::string& route : allowed) message += " '" + route + "'";
    throw Error(ErrorKind::Usage, message);
}

void refuseOversample(const BandlimitRequest& request) {
    if (!request.oversample) return;
    throw Error(ErrorKind::Usage,
                "oversample has no meaning on the exact route; expected route='sampled' with a "
                "shape, or a mesh that is not closed");
}

void refuseBase(const BandlimitRequest& request) {
    if (!request.base) return;
    throw Error(ErrorKind::Usage,
                "base is for free-form surfaces; expected bandvox.Patches, or a "
                ".bpt or .obj file of them");
}

// Sampling is by far the largest error, so what is allowed is allowed to it.
DensityOptions besideSampling(DensityOptions options) {
    options.tolerance = std::min(options.tolerance, DensityOptions().tolerance);
    return options;
}

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
            surfaceToDensity(MeshSource(name, std::move(closed.mesh)), request.options, progress);
        if (request.oversample) {
            result.warnings.emplace_back(
                "oversample was not used: caps close the whole mesh, which took the exact route");
        }
    } else {
        SoupDensityOptions options;
        options.density = besideSampling(request.options);
        options.rowsPerVoxel = request.oversample.value_or(options.rowsPerVoxel);
        options.samplingTolerance = request.tolerance.value_or(options.samplingTolerance);
        result = soupToDensity({name, std::move(closed.soup), std::move(closed.mesh)}, options,
                               progress);
    }
    result.metadata.holesCapped = static_cast<int>(closed.report.holes.size());
    addWarnings(solid.warnings, result);
    return result;
}

DensityResult densityOfMeshFile(const std::filesystem::path& path, const BandlimitRequest& request,
                                Progress& progress) {
    MeshFile file = readMesh(path, progress);
    DensityResult result =
        densityOfMesh(path.filename().string(), std::move(file.mesh), request, progress);
    addWarnings(file.warnings, result);
    return result;
}

DensityResult densityOfPatches(const std::string& name, const PatchModel& model,
                               const BandlimitRequest& request, Progress& progress) {
    const PatchSolid solid = makePatchSolid(
        name, model.patches, {.unite = request.isUnion, .base = request.base}, progress);
    DensityResult result = surfaceToDensity(*solid.source, request.options, progress);
    result.metadata.holesCapped = static_cast<int>(solid.report.holes.size());
    addWarnings(solid.report.warnings, result);
    return result;
}

DensityResult densityOfField(const FieldSource& field, const BandlimitRequest& request,
                             Progress& progress) {
    FieldDensityOptions options;
    options.density = besideSampling(request.options);
    options.oversample = request.oversample.value_or(options.oversample);
    options.samplingTolerance = request.tolerance.value_or(options.samplingTolerance);
    return fieldToDensity(field, options, progress);
}

py::object ofShape(const std::string& shape, const BandlimitRequest& request) {
    requireRoute(request, {"auto", "exact", "sampled"}, "a built-in shape");
    refuseBase(request);
    if (request.route != "sampled") refuseOversample(request);
    return madeDensity(request, [&](Progress& progress) {
        const auto boundary = makeShapeBoundary(shape);
        if (request.route != "sampled") {
            return surfaceToDensity(*boundary, request.options, progress);
        }
        DensityResult result = densityOfField(*makeShapeField(shape), request, progress);
        // Of a shape, unlike other fields, the volume is known.
        result.metadata.sourceVolume = boundary->volume();
        return result;
    });
}

void requireForPatches(const BandlimitRequest& request) {
    requireRoute(request, {"auto", "exact"}, "free-form surfaces");
    refuseOversample(request);
}

py::object ofFile(const std::filesystem::path& path, const BandlimitRequest& request) {
    const std::string name = path.filename().string();
    if (isPatchFile(path)) {
        requireForPatches(request);
        return madeDensity(request, [&](Progress& progress) {
            const PatchModel model = readPatches(path, progress);
            DensityResult result = densityOfPatches(name, model, request, progress);
            addWarnings(model.warnings, result);
            return result;
        });
    }
    requireRoute(request, {"auto", "exact", "winding"}, "a mesh");
    refuseBase(request);
    return madeDensity(
        request, [&](Progress& progress) { return densityOfMeshFile(path, request, progress); });
}

py::object ofMesh(const MeshObject& mesh, const BandlimitRequest& request) {
    requireRoute(request, {"auto", "exact", "winding"}, "a mesh");
    refuseBase(request);
    return madeDensity(request, [&](Progress& progress) {
        return densityOfMesh(mesh.name, mesh.surface.mesh, request, progress);
    });
}

py::object ofPatches(const PatchesObject& patches, const BandlimitRequest& request) {
    requireForPatches(request);
    return madeDensity(request, [&](Progress& progress) {
        return densityOfPatches(patches.name, patches.model, request, progress);
    });
}

py::object ofFunction(const py::object& function, const BandlimitRequest& request) {
    requireRoute(request, {"auto", "sampled"}, "a function");
    refuseBase(request);
    const openvdb::BBoxd box = boundsOfFunction(request.bounds);
    const CallableField field(function, box);
    try {
        return madeDensity(request, [&](Progress& progress) {
            field.watch(progress);
            return densityOfField(field, request, progress);
        });
    } catch (const Error&) {
        field.rethrow();
        throw;
    }
}

py::object bandlimit(const py::object& source, const BandlimitRequest& request) {
    if (isPath(source)) {
        const auto path = pathOf(source);
        if (isShape(path.string())) return ofShape(path.string(), request);
        return ofFile(path, request);
    }
    if (py::isinstance<PatchesObject>(source)) {
        return ofPatches(source.cast<const PatchesObject&>(), request);
    }
    if (const auto mesh = meshOf(source)) return ofMesh(*mesh, request);
    if (PyCallable_Check(source.ptr()) != 0) return ofFunction(source, request);
    throw Error(ErrorKind::Usage, std::string("found a ") + Py_TYPE(source.ptr())->tp_name +
                                      "; expected a file, 'shape:NAME', a Mesh, Patches, (points, "
                                      "triangles) or a function; bandlimit_grid is for grids, and "
                                      "bandlimit_points for points");
}

}  // namespace

DensityResult densityOfSolid(const std::filesystem::path& path, const DensityOptions& options,
                             Progress& progress) {
    if (isShape(path.string())) {
        return surfaceToDensity(*makeShapeBoundary(path.string()), options, progress);
    }
    BandlimitRequest request;
    request.options = options;
    return densityOfMeshFile(path, request, progress);
}

void bindBandlimit(py::module_& module) {
    const DensityOptions standard;
    module.def(
        "bandlimit",
        [](const py::object& source, int resolution, double voxelSize, double cutoff, double order,
           const std::optional<double>& tolerance, int tile, bool clamp, const py::object& iso,
           const std::string& route, const std::string& overlap, std::optional<int> oversample,
           const std::optional<double>& base, const py::object& bounds, const py::object& shard,
           int threads, const py::object& progress) {
            BandlimitRequest request{
                densityRequestOf({cutoff, order, tile, clamp}, tolerance, iso, threads, progress)};
            DensityOptions& options = request.options;
            options.resolution = resolution;
            options.voxelSize = voxelSize;
            options.shard = shardOf(shard);
            choiceOf(route, kRoutes, "route");
            request.route = route;
            request.isUnion = choiceOf(overlap, {"union", "sum"}, "overlap") == 0;
            options.sumOverlaps = !request.isUnion;
            request.oversample = oversample;
            request.base = base;
            request.bounds = bounds;
            return bandlimit(source, request);
        },
        py::arg("source"), py::kw_only(), py::arg("resolution") = standard.resolution,
        py::arg("voxel_size") = 0.0, py::arg("cutoff") = standard.filter.cutoff,
        py::arg("order") = standard.filter.order, py::arg("tolerance") = py::none(),
        py::arg("tile") = 0, py::arg("clamp") = false, py::arg("iso") = standard.iso,
        py::arg("route") = "auto", py::arg("overlap") = "union", py::arg("oversample") = py::none(),
        py::arg("base") = py::none(), py::arg("bounds") = py::none(), py::arg("shard") = py::none(),
        py::arg("threads") = 0, py::arg("progress") = py::none(),
        R"(Turns a solid into a band-limited density: 1 inside, 0 outside, and in between only what
the grid can hold.

source: a file of a mesh or of free-form surfaces, 'shape:NAME', a Mesh, (points, triangles),
Patches, which are filled as they are, without triangles, or a function f(x, y, z) of arrays with
bounds, its values 0 outside of them. resolution: voxels along the longest side, 1 to 2**20;
voxel_size: world units, instead. cutoff (cycles per voxel, 0.01 to 0.5) and order (1 to 64) of the
filter exp(-(k/cutoff)**order). tolerance: error of the density allowed, 1e-6 to 0.05, 1e-4 if it is
None; where the solid is sampled the error that is measured may be 0.05, a warning if it is more,
unless this says how much. tile: side of the cube filtered at a time, voxels, even, 512 at most; 0
chooses. clamp: limit the density to 0 .. 1. iso: the value that is the surface; 'volume' takes the
one that encloses the volume of the source. route: 'auto', 'exact', 'sampled' (shapes, functions) or
'winding' (meshes with openings). overlap: 'union' or 'sum' of a source's shells. oversample:
samples along a voxel's side, or rows of the winding number, 1 to 64; 8 and 4 if it is None. base:
of free-form surfaces that are a height field, the solid between them and the plane z = base, world
units. shard: (i, n) makes part i of n, from 1, which join_shards joins. threads: 0 for all.
progress: called as progress(stage, fraction or None).

What was measured is in the grid's metadata. Raises UsageError, InputError, ResultError,
OutOfMemoryError; warns by BandvoxWarning.)");
    module.def("shape_names", &shapeNames, "Names of the built-in shapes.");
}

}  // namespace bandvox::python
