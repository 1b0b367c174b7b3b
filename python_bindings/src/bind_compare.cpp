// How far grids and meshes are from each other, and what they are.

#include "background.h"
#include "bindings.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "iso_argument.h"
#include "paths.h"
#include "solid_mesh.h"

#include <bandvox/compare/compare_grids.h>
#include <bandvox/compare/compare_surfaces.h>
#include <bandvox/compare/grid_to_surface.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

/// One of the two that are compared: a grid, a mesh, or the file of one.
struct Side {
    openvdb::FloatGrid::ConstPtr grid;
    std::shared_ptr<const MeshObject> mesh;
    std::filesystem::path path;
    ComparedSurface surface;
    std::optional<double> volume, voxel;
};

struct CompareRequest {
    IsoArgument iso;
    bool values = true, surfaces = true;
    double tolerance = 0;  // of the largest distance, voxels
    int cuts = 1;
};

struct Comparison {
    std::optional<GridDifference> values;
    std::optional<SurfaceDifference> surfaces;
    std::vector<std::string> warnings;
};

Side sideOf(const py::object& object) {
    Side side;
    if (isPath(object)) {
        side.path = pathOf(object);
    } else if (const auto mesh = meshOf(object)) {
        side.mesh = mesh;
    } else {
        side.grid = floatGridOf(object);
    }
    return side;
}

void makeMeshSurface(Side& side, std::vector<std::string>& warnings, Progress& progress) {
    Mesh read;
    if (side.mesh) {
        read = side.mesh->surface.mesh;
    } else {
        MeshFile file = readMesh(side.path, progress);
        warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
        read = std::move(file.mesh);
    }
    SolidMesh solid = solidOf(std::move(read), Capping::Sensible, true, progress);
    warnings.insert(warnings.end(), solid.warnings.begin(), solid.warnings.end());
    Mesh& mesh = side.surface.mesh;
    mesh = std::move(solid.closed.mesh);
    const Mesh& soup = solid.closed.soup;
    if (soup.triangles.empty()) {
        side.volume = MeshSource("", mesh).volume();
        return;
    }
    // Triangles that only a winding number makes a solid of are a surface all the same.
    const auto first = static_cast<openvdb::Int32>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), soup.points.begin(), soup.points.end());
    for (const openvdb::Vec3I& t : soup.triangles) {
        mesh.triangles.push_back(t + openvdb::Vec3I(first));
    }
}

void makeSurface(Side& side, const CompareRequest& request, std::vector<std::string>& warnings,
                 Progress& progress) {
    if (!side.grid) return makeMeshSurface(side, warnings, progress);
    SurfaceOfGrid made = gridToSurface(
        side.grid, {isoFor(request.iso, side.grid, progress), request.cuts}, progress);
    side.surface = std::move(made.surface);
    side.volume = made.volume;
    side.voxel = made.voxel;
}

double distanceTolerance(const std::array<Side, 2>& sides, double inVoxels) {
    for (const Side& side : sides) {
        if (side.voxel) return inVoxels * *side.voxel;
    }
    openvdb::BBoxd box;
    for (const Side& side : sides) {
        for (const openvdb::Vec3d& point : side.surface.mesh.points) box.expand(point);
    }
    return inVoxels * 1e-3 * box.extents().length();
}

Comparison compareSides(std::array<Side, 2>& sides, const CompareRequest& request,
                        Progress& progress) {
    Comparison found;
    if (request.values) found.values = compareGrids(sides[0].grid, sides[1].grid, {}, progress);
    if (!request.surfaces) return found;
    for (Side& side : sides) makeSurface(side, request, found.warnings, progress);
    found.surfaces =
        compareSurfaces(sides[0].surface, sides[1].surface,
                        {.tolerance = distanceTolerance(sides, request.tolerance)}, progress);
    return found;
}

py::tuple tupleOf(const openvdb::Vec3d& place) {
    return py::make_tuple(place[0], place[1], place[2]);
}

py::dict dictOf(const OneSidedDistance& distance) {
    py::dict one;
    one["maximum"] = distance.maximum;
    one["at_most"] = distance.atMost;
    one["at"] = tupleOf(distance.at);
    one["nearest"] = tupleOf(distance.nearest);
    one["mean"] = distance.mean;
    one["rms"] = distance.rms;
    one["area"] = distance.area;
    return one;
}

py::dict dictOf(const Comparison& found, const std::array<Side, 2>& sides) {
    py::dict result;
    if (found.values) {
        const GridDifference& values = *found.values;
        const char* const lattices[] = {"same", "shifted", "resampled"};
        result["lattices"] = lattices[static_cast<std::size_t>(values.lattices)];
        result["maximum"] = values.maximum;
        result["at"] = tupleOf(values.at);
        result["values"] = py::make_tuple(values.valueA, values.valueB);
        result["rms"] = values.rms;
        result["mean"] = values.mean;
        result["mean_absolute"] = values.meanAbsolute;
        result["voxels"] = values.voxels;
        result["integrals"] = py::make_tuple(values.integralA, values.integralB);
    }
    if (found.surfaces) {
        const SurfaceDifference& surfaces = *found.surfaces;
        result["volumes"] = py::make_tuple(sides[0].volume, sides[1].volume);
        result["hausdorff"] = surfaces.hausdorff;
        result["hausdorff_at_most"] = surfaces.hausdorffAtMost;
        result["mean_distance"] = surfaces.meanDistance;
        result["from_a"] = dictOf(surfaces.fromA);
        result["from_b"] = dictOf(surfaces.fromB);
        result["angle_mean"] = surfaces.angles.mean;
        result["angle_95"] = surfaces.angles.percent95;
        result["angle_maximum"] = surfaces.angles.maximum;
    }
    return result;
}

py::dict compare(const py::object& a, const py::object& b, const py::object& only,
                 CompareRequest request, int threads, const py::object& progress) {
    std::array<Side, 2> sides{sideOf(a), sideOf(b)};
    const bool areGrids = sides[0].grid && sides[1].grid;
    if (!only.is_none()) {
        const std::size_t part = choiceOf(only.cast<std::string>(), {"values", "surfaces"}, "only");
        request.values = part == 0;
        request.surfaces = part == 1;
        if (request.values && !areGrids) {
            throw Error(ErrorKind::Usage,
                        "only is 'values', and a mesh has none; expected two "
                        "grids");
        }
    }
    request.values = request.values && areGrids;
    if (!(request.tolerance >= 1e-4 && request.tolerance <= 10)) {
        throw Error(ErrorKind::Usage, "distance_tolerance is " + std::to_string(request.tolerance) +
                                          "; expected 0.0001 to 10 voxels");
    }
    if (areGrids) {
        const std::string place = placeDifference(*sides[0].grid, *sides[1].grid);
        if (!place.empty()) {
            throw Error(ErrorKind::Input, "the grids are not in one world: " + place);
        }
    }
    const Comparison found = inBackground(progress, threads, [&](Progress& watched) {
        return compareSides(sides, request, watched);
    });
    warn(found.warnings);
    return dictOf(found, sides);
}

}  // namespace

void bindCompare(py::module_& module) {
    module.def(
        "compare",
        [](const py::object& a, const py::object& b, const py::object& only, const py::object& iso,
           double distanceTolerance_, int cuts, int threads, const py::object& progress) {
            return compare(a, b, only, {isoArgumentOf(iso), true, true, distanceTolerance_, cuts},
                           threads, progress);
        },
        py::arg("a"), py::arg("b"), py::kw_only(), py::arg("only") = py::none(),
        py::arg("iso") = py::none(), py::arg("distance_tolerance") = 0.1, py::arg("cuts") = 1,
        py::arg("threads") = 0, py::arg("progress") = py::none(),
        R"(How far two grids, meshes or files of meshes are from each other, a dictionary.

Of two grids: lattices, 'same', 'shifted' or 'resampled'; maximum, rms, mean and mean_absolute of
the difference b - a; at, where it is largest, and values there; voxels; integrals. Of the surfaces:
volumes (None of a mesh that is not closed), hausdorff, hausdorff_at_most and mean_distance, world
units; from_a and from_b, the distances one way; angle_mean, angle_95 and angle_maximum of the
normals, degrees. only: 'values' or 'surfaces'. iso: as of to_mesh, of both. distance_tolerance: of
the largest distance, voxels, or between meshes thousandths of the diagonal of their box. cuts: how
often triangles of a grid's surface are cut into four, 0 to 3.)");
}

}  // namespace bandvox::python
