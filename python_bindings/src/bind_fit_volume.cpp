// Smooth fields through values at scattered places in space.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "scattered_arrays.h"
#include "solid_mesh.h"

#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/scatter/fit_volume.h>
#include <bandvox/scatter/spline_volume_to_grids.h>

#include <fit_columns.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

struct VolumeObject {
    VolumeFit fit;
    std::string name = "points";
    std::vector<std::string> columns;  // their names; empty of arrays
};

using SharedVolume = std::shared_ptr<VolumeObject>;

void judgeVolume(const VolumeFit& fit, const FitVolumeOptions& options, bool hasTolerance) {
    if (!fit.noiseReached) {
        std::string message = "no field differs from the values by as much as smooth says; ";
        warn({message + "this one does by " + inDigits(fit.rms) + " of the range"});
    }
    if (options.noise > 0) return;
    judgeResidual(
        {"field", fit.largest, options.tolerance, hasTolerance, options.maxLevel.has_value()});
}

SharedVolume fittedVolume(const py::object& places, const py::object& values,
                          const std::vector<std::string>& columns, const FitVolumeOptions& options,
                          bool hasTolerance, int threads, const py::object& progress) {
    auto object = std::make_shared<VolumeObject>();
    ScatteredInput input(places, values, columns, 3);
    if (!input.fileName().empty()) object->name = input.fileName();
    object->fit = inBackground(progress, threads, [&](Progress& watched) {
        const ScatteredPoints& points = input.points(watched);
        object->columns = points.names;
        return fitVolume(points, options, watched);
    });
    judgeVolume(object->fit, options, hasTolerance);
    return object;
}

void requireColumns(const SplineVolume& volume, int first, int count) {
    if (first >= 0 && count > 0 && first + count <= volume.columns()) return;
    throw Error(ErrorKind::Usage, "column is " + std::to_string(first) + "; expected one of " +
                                      std::to_string(volume.columns()) + " from 0 on");
}

py::array valuesAt(const VolumeObject& self, const py::object& points, int column) {
    requireColumns(self.fit.volume, column, 1);
    const std::vector<openvdb::Vec3d> places = vectorsOf(points, "points");
    std::vector<double> values(places.size());
    {
        const py::gil_scoped_release unlocked;
        parallelFor(static_cast<std::int64_t>(places.size()), [&](std::int64_t i) {
            const auto at = static_cast<std::size_t>(i);
            values[at] = self.fit.volume.value(places[at], column);
        });
    }
    return ownedArray(std::move(values), {static_cast<py::ssize_t>(places.size())});
}

py::array coveredAt(const VolumeObject& self, const py::object& points) {
    const std::vector<openvdb::Vec3d> places = vectorsOf(points, "points");
    py::array_t<bool> covered(static_cast<py::ssize_t>(places.size()));
    bool* const to = covered.mutable_data();
    for (std::size_t i = 0; i < places.size(); ++i) to[i] = self.fit.volume.covers(places[i]);
    return covered;
}

double voxelSizeOf(const SplineVolume& volume, int resolution, double voxelSize) {
    if (voxelSize == 0) {
        const openvdb::Vec3d size = volume.bounds().extents();
        if (resolution < 1) {
            throw Error(ErrorKind::Usage,
                        "resolution is " + std::to_string(resolution) + "; expected 1 or more");
        }
        voxelSize = std::max({size[0], size[1], size[2]}) / resolution;
    }
    if (!(voxelSize > 0)) throw Error(ErrorKind::Usage, "voxel_size: expected a number above 0");
    return voxelSize;
}

/// How volumes are sampled.
struct SamplingArguments {
    int resolution;
    double voxelSize;
    int threads;
    py::object progress;
};

openvdb::GridPtrVec sampledGrids(const VolumeObject& self, const std::vector<ColumnGrid>& wanted,
                                 const SamplingArguments& arguments) {
    const SplineVolume& volume = self.fit.volume;
    const double side = voxelSizeOf(volume, arguments.resolution, arguments.voxelSize);
    openvdb::GridPtrVec grids = inBackground(
        arguments.progress, arguments.threads,
        [&](Progress& watched) { return splineVolumeToGrids(volume, wanted, side, watched); });
    for (const auto& grid : grids) {
        setSourceMetadata(*grid, self.name);
        grid->insertMeta("bandvox_reach", openvdb::DoubleMetadata(volume.reach()));
    }
    return grids;
}

py::object gridOfVolume(const VolumeObject& self, const std::string& name, int column, int columns,
                        const std::string& quantity, const SamplingArguments& arguments) {
    if (columns != 1 && columns != 3) {
        throw Error(ErrorKind::Usage, "columns is " + std::to_string(columns) +
                                          "; expected 1, or 3 for a VectorGrid");
    }
    requireColumns(self.fit.volume, column, columns);
    ColumnGrid wanted{name, column, columns,
                      name == "vel" ? openvdb::VEC_CONTRAVARIANT_RELATIVE : openvdb::VEC_INVARIANT};
    if (choiceOf(quantity, {"value", "gradient"}, "quantity") == 1) {
        if (columns != 1) {
            throw Error(ErrorKind::Usage, "a gradient is of one column, and columns is 3");
        }
        wanted.type = openvdb::VEC_COVARIANT;
        wanted.isGradient = true;
    }
    return objectOf(sampledGrids(self, {wanted}, arguments).front());
}

/// A grid for each column, or for three that belong together by their names.
py::list gridsOfVolume(const VolumeObject& self, const SamplingArguments& arguments) {
    std::vector<std::string> names = self.columns;
    for (int i = static_cast<int>(names.size()); i < self.fit.volume.columns(); ++i) {
        names.push_back(self.fit.volume.columns() == 1 ? "value"
                                                       : "value " + std::to_string(i + 1));
    }
    py::list result;
    for (const auto& grid : sampledGrids(self, app::gridsOfColumns(names), arguments)) {
        result.append(objectOf(grid));
    }
    return result;
}

py::tuple corner(const openvdb::Vec3d& place) {
    return py::make_tuple(place[0], place[1], place[2]);
}

}  // namespace

void bindFitVolume(py::module_& module) {
    py::class_<VolumeObject, SharedVolume>(
        module, "Volume",
        "A smooth field in space, as fit_volume makes it. Call it with points for its values. Safe "
        "to use from many threads.")
        .def("__call__", &valuesAt, py::arg("points"), py::kw_only(), py::arg("column") = 0,
             "(n,) float64: the values at points of shape (n, 3), world units; anything where "
             "covers is False.")
        .def("covers", &coveredAt, py::arg("points"),
             "(n,) bool: whether there is a value, within reach of the places fitted.")
        .def(
            "grid",
            [](const VolumeObject& self, const std::string& name, int column, int columns,
               const std::string& quantity, int resolution, double voxelSize, int threads,
               const py::object& progress) {
                return gridOfVolume(self, name, column, columns, quantity,
                                    {resolution, voxelSize, threads, progress});
            },
            py::kw_only(), py::arg("name") = "density", py::arg("column") = 0,
            py::arg("columns") = 1, py::arg("quantity") = "value", py::arg("resolution") = 256,
            py::arg("voxel_size") = 0.0, py::arg("threads") = 0, py::arg("progress") = py::none(),
            "A column as a Grid, or three from column on as a VectorGrid. quantity: 'value', or "
            "'gradient', of one column, a VectorGrid per world unit. resolution: voxels along the "
            "longest side of the points' box; voxel_size: world units, instead.")
        .def(
            "grids",
            [](const VolumeObject& self, int resolution, double voxelSize, int threads,
               const py::object& progress) {
                return gridsOfVolume(self, {resolution, voxelSize, threads, progress});
            },
            py::kw_only(), py::arg("resolution") = 256, py::arg("voxel_size") = 0.0,
            py::arg("threads") = 0, py::arg("progress") = py::none(),
            "A list of grids, one for each column, named after it; columns named r, g and b become "
            "the VectorGrid Cd, and those of an x, y and z one of their own. The others are those "
            "of grid.")
        .def_property_readonly(
            "bounds",
            [](const VolumeObject& self) {
                const openvdb::BBoxd box = self.fit.volume.bounds();
                return py::make_tuple(corner(box.min()), corner(box.max()));
            },
            "The lowest and the highest place, world units.")
        .def_property_readonly(
            "reach", [](const VolumeObject& self) { return self.fit.volume.reach(); },
            "How far from a place there are values, world units.")
        .def_property_readonly(
            "columns", [](const VolumeObject& self) { return self.fit.volume.columns(); },
            "How many values there are at a place.")
        .def_readonly("column_names", &VolumeObject::columns,
                      "Their names in the file that they come from; empty of arrays.")
        .def_property_readonly(
            "largest", [](const VolumeObject& self) { return self.fit.largest; },
            "The largest difference from a value, in parts of their range.")
        .def("__repr__", [](const VolumeObject& self) {
            return "<bandvox.Volume of '" + self.name +
                   "': " + std::to_string(self.fit.volume.controlPoints()) + " control points>";
        });
    const FitVolumeOptions standard;
    module.def(
        "fit_volume",
        [](const py::object& places, const py::object& values,
           const std::vector<std::string>& columns, const std::optional<double>& tolerance,
           double smooth, const std::optional<int>& maxLevel, const std::optional<double>& reach,
           double tension, int threads, const py::object& progress) {
            if (tolerance && smooth != 0) {
                throw Error(ErrorKind::Usage, "tolerance and smooth exclude each other");
            }
            FitVolumeOptions options;
            options.tolerance = tolerance.value_or(options.tolerance);
            options.noise = smooth;
            options.maxLevel = maxLevel;
            options.reach = reach;
            options.tension = tension;
            return fittedVolume(places, values, columns, options, tolerance.has_value(), threads,
                                progress);
        },
        py::arg("places"), py::arg("values") = py::none(), py::kw_only(),
        py::arg("columns") = std::vector<std::string>{}, py::arg("tolerance") = py::none(),
        py::arg("smooth") = 0.0, py::arg("max_level") = py::none(), py::arg("reach") = py::none(),
        py::arg("tension") = standard.tension, py::arg("threads") = 0,
        py::arg("progress") = py::none(),
        R"(Fits a smooth field to values at scattered places in space; a Volume.

places: (n, 3), world units, and values: (n,) or (n, columns); or a file alone, and columns: names,
or numbers from 1, of x, y, z and values. reach: how far from the places there are values, world
units; chosen if it is None. max_level: at most 2**max_level cells along the longest side, 1 to 16.
tension: as of fit, but in units of the longest side, 0.01 to 10000. The others are as of fit.)");
}

}  // namespace bandvox::python
