// Solids to binary voxels, and colours to grids.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "callable_field.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "paths.h"
#include "solid_mesh.h"
#include "surface_object.h"

#include <bandvox/bandlimit/surface_to_color.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/colored_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/shapes.h>
#include <bandvox/voxelize/field_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>
#include <bandvox/voxelize/soup_to_voxels.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

enum class VoxelBackend { Auto, Cpu, Gpu };

struct VoxelRequest {
    VoxelOptions voxels;
    VoxelBackend backend = VoxelBackend::Auto;
    GpuMethod gpuMethod = GpuMethod::Bits;
    int threads = 0;
    py::object progress;
};

/// By the GPU if it is asked for, or there is one and it can.
std::optional<VoxelResult> voxelsByGpu(const MeshSource& source, const VoxelRequest& request,
                                       Progress& progress) {
    if (request.backend == VoxelBackend::Cpu) return std::nullopt;
    const bool canChoose = request.backend == VoxelBackend::Auto;
    if (canChoose && !findGpu().isHardware) return std::nullopt;
    try {
        return meshToVoxelsOnGpu(source, request.voxels, request.gpuMethod, progress);
    } catch (const Error& error) {
        const bool isDevices = error.kind() == ErrorKind::Runtime ||
                               error.kind() == ErrorKind::Memory ||
                               error.kind() == ErrorKind::Usage;
        if (!canChoose || !isDevices) throw;
        return std::nullopt;
    }
}

VoxelResult voxelsOfMesh(const std::string& name, Mesh mesh, const VoxelRequest& request,
                         Progress& progress) {
    SolidMesh solid = solidOf(std::move(mesh), Capping::Sensible, true, progress);
    ClosedMesh& closed = solid.closed;
    std::optional<VoxelResult> result;
    if (!closed.soup.triangles.empty()) {
        if (request.backend == VoxelBackend::Gpu) {
            throw Error(ErrorKind::Usage,
                        "backend is 'gpu', and what of the mesh is not closed goes by its winding "
                        "number; expected 'cpu' or 'auto'");
        }
        result = soupToVoxels({name, std::move(closed.soup), std::move(closed.mesh)},
                              request.voxels, progress);
    } else {
        const MeshSource source(name, std::move(closed.mesh));
        result = voxelsByGpu(source, request, progress);
        if (!result) result = meshToVoxels(source, request.voxels, progress);
    }
    result->warnings.insert(result->warnings.begin(), solid.warnings.begin(), solid.warnings.end());
    return std::move(*result);
}

VoxelResult voxelsOf(const py::object& source, const VoxelRequest& request,
                     const py::object& bounds) {
    const auto work = [&](const auto& run) {
        return inBackground(request.progress, request.threads, run);
    };
    if (const auto mesh = meshOf(source)) {
        return work([&](Progress& progress) {
            return voxelsOfMesh(mesh->name, mesh->surface.mesh, request, progress);
        });
    }
    const bool isFile = isPath(source);
    const auto path = isFile ? pathOf(source) : std::filesystem::path();
    if (isFile && !isShape(path.string())) {
        return work([&](Progress& progress) {
            MeshFile file = readMesh(path, progress);
            VoxelResult result =
                voxelsOfMesh(path.filename().string(), std::move(file.mesh), request, progress);
            result.warnings.insert(result.warnings.begin(), file.warnings.begin(),
                                   file.warnings.end());
            return result;
        });
    }
    if (request.backend == VoxelBackend::Gpu) {
        throw Error(ErrorKind::Usage,
                    "backend is 'gpu', and the source is a formula; expected 'cpu' or 'auto'");
    }
    if (isFile) {
        return work([&](Progress& progress) {
            return fieldToVoxels(*makeShapeField(path.string()), request.voxels, progress);
        });
    }
    if (PyCallable_Check(source.ptr()) == 0) {
        throw Error(
            ErrorKind::Usage,
            std::string("found a ") + Py_TYPE(source.ptr())->tp_name +
                "; expected a file, 'shape:NAME', a Mesh, (points, triangles) or a function");
    }
    const CallableField field(source, boundsOfFunction(bounds));
    try {
        return work([&](Progress& progress) {
            field.watch(progress);
            return fieldToVoxels(field, request.voxels, progress);
        });
    } catch (const Error&) {
        field.rethrow();
        throw;
    }
}

/// Triangles whose corners have the colours of a mesh's points.
ColoredMesh coloredMeshOf(const MeshObject& mesh) {
    const auto& colors = mesh.surface.colors;
    if (colors.empty()) {
        throw Error(ErrorKind::Usage, "the mesh has no colors; expected one for each point");
    }
    ColoredMesh colored;
    colored.name = mesh.name;
    colored.mesh = mesh.surface.mesh;
    for (const openvdb::Vec3I& t : colored.mesh.triangles) {
        TrianglePaint paint;
        paint.color = {colors[t[0]], colors[t[1]], colors[t[2]]};
        paint.texture = TrianglePaint::kNoTexture;
        colored.paints.push_back(paint);
    }
    return colored;
}

py::object colorsFor(const py::object& source, const py::object& density, double cutoff,
                     double order, int tile, int threads, const py::object& progress) {
    const auto grid = floatGridOf(density);
    ColorOptions options;
    options.voxelSize = grid->voxelSize()[0];
    options.filter = ExponentialFilter{order, cutoff};
    options.tile = tile;
    const bool isFile = isPath(source);
    const auto path = isFile ? pathOf(source) : std::filesystem::path();
    const auto surface =
        py::isinstance<SurfaceObject>(source) ? source.cast<SharedSurface>() : nullptr;
    const auto mesh = isFile || surface ? nullptr : meshOf(source);
    if (!isFile && !surface && !mesh) {
        throw Error(ErrorKind::Usage, std::string("found a ") + Py_TYPE(source.ptr())->tp_name +
                                          "; expected a file, a Mesh with colors or a Surface "
                                          "with columns of them");
    }
    std::vector<std::string> warnings;
    const ColorResult result = inBackground(progress, threads, [&](Progress& watched) {
        if (surface) {
            return surfaceToColor(coloredSurface(*surface, options.voxelSize), options, watched);
        }
        if (!isFile) return surfaceToColor(coloredMeshOf(*mesh), options, watched);
        const ColoredMeshFile file = readColoredMesh(path, watched);
        warnings = file.warnings;
        return surfaceToColor(file.colored, options, watched);
    });
    warn(warnings);
    return objectOf(result.grid);
}

}  // namespace

void bindVoxelize(py::module_& module) {
    const VoxelOptions standard;
    module.def(
        "voxelize",
        [](const py::object& source, int resolution, double voxelSize, int threshold, bool fraction,
           const std::string& axis, const std::string& backend, const std::string& gpuMethod,
           const std::string& as, const py::object& bounds, int threads,
           const py::object& progress) -> py::object {
            VoxelRequest request;
            request.voxels.resolution = resolution;
            request.voxels.voxelSize = voxelSize;
            request.voxels.threshold = threshold;
            request.voxels.fraction = fraction;
            request.voxels.axis = static_cast<ScanAxis>(choiceOf(axis, {"x", "y", "z"}, "axis"));
            request.backend =
                static_cast<VoxelBackend>(choiceOf(backend, {"auto", "cpu", "gpu"}, "backend"));
            request.gpuMethod =
                static_cast<GpuMethod>(choiceOf(gpuMethod, {"bits", "slices"}, "gpu_method"));
            const bool isMask = choiceOf(as, {"density", "mask"}, "as_") == 1;
            request.threads = threads;
            request.progress = progress;
            if (threshold > 0 && fraction) {
                throw Error(ErrorKind::Usage, "threshold and fraction exclude each other");
            }
            if (isMask && fraction) {
                throw Error(ErrorKind::Usage,
                            "a mask cannot hold what fraction gives; expected as_='density', or "
                            "threshold");
            }
            const VoxelResult result = voxelsOf(source, request, bounds);
            warn(result.warnings);
            if (isMask) return objectOf(voxelsToMask(*result.grid));
            return objectOf(result.grid);
        },
        py::arg("source"), py::kw_only(), py::arg("resolution") = standard.resolution,
        py::arg("voxel_size") = 0.0, py::arg("threshold") = 0, py::arg("fraction") = false,
        py::arg("axis") = "x", py::arg("backend") = "auto", py::arg("gpu_method") = "bits",
        py::arg("as_") = "density", py::arg("bounds") = py::none(), py::arg("threads") = 0,
        py::arg("progress") = py::none(),
        R"(Turns a solid into voxels that are 1 where their centres are inside, a Grid; as_='mask'
gives a MaskGrid, True there.

source, resolution, voxel_size, bounds: as of bandlimit. threshold: 1 to 8 of a voxel's eight
sub-samples that have to be inside, instead of its centre; fraction: the value is the share of them.
axis: of the rows that are scanned. backend: 'cpu', 'gpu' (OpenGL, for closed meshes), or 'auto',
which takes a GPU if there is one; gpu_method: 'bits', all slices at once, or 'slices', one by one.
All of them give the same voxels.)");
    const ColorOptions coloring;
    module.def("colors", &colorsFor, py::arg("source"), py::arg("density"), py::kw_only(),
               py::arg("cutoff") = coloring.filter.cutoff, py::arg("order") = coloring.filter.order,
               py::arg("tile") = 0, py::arg("threads") = 0, py::arg("progress") = py::none(),
               R"(The colours of a surface as a VectorGrid 'Cd' on the lattice of a density.

source: a mesh file with colours or textures, a Mesh with colors, or a Surface with columns named r,
g and b. Linear light. cutoff, order, tile: as of the density. Raises InputError if a file has no
colour.)");
}

}  // namespace bandvox::python
