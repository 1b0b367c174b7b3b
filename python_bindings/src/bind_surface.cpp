// What a fitted surface is to Python: a function, samples, patches, a mesh, files, a solid.

#include "arrays.h"
#include "background.h"
#include "errors.h"
#include "grid_object.h"
#include "mesh_object.h"
#include "patches_object.h"
#include "scattered_arrays.h"
#include "surface_object.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/atomic_file.h>
#include <bandvox/core/parallel.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/render/image.h>
#include <bandvox/scatter/colored_height_field.h>
#include <bandvox/scatter/height_field_source.h>
#include <bandvox/scatter/surface_quantity.h>
#include <bandvox/scatter/write_surface.h>

#include <fit_columns.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

/// `width` numbers for each place, by visit(jet, numbers).
template <typename Visit>
py::object evaluatedSurface(const SurfaceObject& self, const py::object& x, const py::object& y,
                            int column, std::size_t width, const Visit& visit) {
    if (column < 0 || column >= self.surface.columns()) {
        throw Error(ErrorKind::Usage, "column is " + std::to_string(column) + "; expected one of " +
                                          std::to_string(self.surface.columns()) + " from 0 on");
    }
    PlanePlaces places = planePlacesOf(x, y);
    std::vector<double> numbers(width * places.x.size());
    {
        constexpr std::size_t kTogether = 4096;
        const py::gil_scoped_release unlocked;
        const std::size_t pieces = (places.x.size() + kTogether - 1) / kTogether;
        parallelFor(static_cast<std::int64_t>(pieces), [&](std::int64_t piece) {
            const std::size_t first = static_cast<std::size_t>(piece) * kTogether;
            const std::size_t last = std::min(places.x.size(), first + kTogether);
            for (std::size_t i = first; i < last; ++i) {
                visit(self.surface.jet(places.x[i], places.y[i], column), &numbers[width * i]);
            }
        });
    }
    if (width > 1) places.shape.push_back(static_cast<py::ssize_t>(width));
    return shaped(std::move(numbers), std::move(places.shape));
}

std::vector<SurfaceQuantity> quantitiesOf(const std::vector<std::string>& names) {
    std::vector<SurfaceQuantity> quantities;
    for (const std::string& name : names) {
        const auto quantity = surfaceQuantityNamed(name);
        if (!quantity ||
            std::find(quantities.begin(), quantities.end(), *quantity) != quantities.end()) {
            std::string known;
            for (const SurfaceQuantity one : surfaceQuantities()) known += " '" + nameOf(one) + "'";
            throw Error(ErrorKind::Usage,
                        "quantities: found '" + name + "'; expected some of" + known + ", once");
        }
        quantities.push_back(*quantity);
    }
    return quantities;
}

py::array sampled(const SurfaceObject& self, int samples, const std::vector<std::string>& names) {
    const std::vector<SurfaceQuantity> quantities = quantitiesOf(names);
    const std::array<int, 2> counts = sampleCounts(self.surface, samples);
    const auto places = static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]);
    std::size_t width = 0;
    for (const SurfaceQuantity one : quantities) {
        width += static_cast<std::size_t>(self.surface.columns() * numbersOf(one));
    }
    py::array_t<double> made({counts[0], counts[1], static_cast<int>(width)});
    double* const numbers = made.mutable_data();
    constexpr std::size_t kBetweenLooks = std::size_t(1) << 20U;
    runInBackground(
        [&](Progress& progress) {
            std::size_t at = 0;
            for (int column = 0; column < self.surface.columns(); ++column) {
                for (const SurfaceQuantity one : quantities) {
                    for (const auto& values :
                         sampleQuantity(self.surface, counts, column, one, progress)) {
                        for (std::size_t i = 0; i < places; ++i) {
                            if (i % kBetweenLooks == 0) progress.throwIfInterrupted();
                            numbers[i * width + at] = values[i];
                        }
                        ++at;
                    }
                }
            }
        },
        py::none(), 0);
    return made;
}

std::shared_ptr<PatchesObject> patchesOf(const SurfaceObject& self) {
    auto result = std::make_shared<PatchesObject>();
    result->name = self.name;
    result->model.objects = {"surface"};
    const BsplineSurface& surface = self.surface;
    const Rectangle& r = surface.rectangle();
    const double dx = r.width() / surface.cells()[0], dy = r.height() / surface.cells()[1];
    for (int i = 0; i < surface.cells()[0]; ++i) {
        for (int j = 0; j < surface.cells()[1]; ++j) {
            const std::array<double, 16> z = surface.bezierOrdinates(i, j);
            BezierPatch patch{.degreeU = 3, .degreeV = 3};
            for (int u = 0; u < 4; ++u) {
                for (int v = 0; v < 4; ++v) {
                    patch.control.push_back({r.x0 + (i + u / 3.0) * dx, r.y0 + (j + v / 3.0) * dy,
                                             z[static_cast<std::size_t>(4 * u + v)], 1});
                }
            }
            result->model.patches.push_back(std::move(patch));
        }
    }
    return result;
}

std::shared_ptr<MeshObject> meshOfSurface(const SurfaceObject& self, int samples) {
    auto mesh = std::make_shared<MeshObject>();
    mesh->name = self.name;
    const auto counts = sampleCounts(self.surface, samples);
    runInBackground(
        [&](Progress& progress) {
            mesh->surface =
                heightFieldMesh(self.surface, counts, 0, app::redColumn(self.columns), progress);
        },
        py::none(), 0);
    return mesh;
}

void saveSurface(const SurfaceObject& self, const std::filesystem::path& path, int samples,
                 const std::vector<std::string>& names) {
    std::vector<SurfaceQuantity> quantities = quantitiesOf(names);
    const int red = app::redColumn(self.columns);
    const auto counts = sampleCounts(self.surface, samples);
    const std::string extension = path.extension().string();
    const bool isKnown =
        extension == ".bpt" || extension == ".npy" || extension == ".exr" || isWritableMesh(path);
    if (!isKnown) {
        throw Error(ErrorKind::Usage,
                    "'" + path.string() +
                        "' is of an unknown kind; expected .bpt, .npy, .exr, "
                        ".obj, .ply, .stl, .gltf or .glb, or density() for a .vdb");
    }
    const bool hasQuantities = extension == ".npy" || extension == ".exr";
    if (!names.empty() && !hasQuantities) {
        throw Error(ErrorKind::Usage,
                    "quantities are for .npy and .exr, and the file is '" + path.string() + "'");
    }
    if (extension == ".npy" && quantities.empty()) quantities = {SurfaceQuantity::Value};
    const auto write = [&](Progress& progress) {
        AtomicFile file(path);
        if (extension == ".bpt") {
            writeBezierPatches(file, self.surface, 0, progress);
        } else if (extension == ".npy") {
            writeSamples(file, self.surface, counts, quantities, progress);
        } else if (extension == ".exr") {
            writeImage(file, heightFieldImage(self.surface, counts, 0, red, quantities, progress),
                       {.color = red >= 0}, progress);
        } else {
            writeMesh(file, heightFieldMesh(self.surface, counts, 0, red, progress), progress);
        }
        file.commit();
    };
    runInBackground(write, py::none(), 0);
}

py::object densityUnder(const SurfaceObject& self, const std::optional<double>& base,
                        const DensityOptions& options, int threads, const py::object& progress) {
    constexpr double kMargin = 0.1;
    const DensityResult result = inBackground(progress, threads, [&](Progress& watched) {
        const double floor = base.value_or(heightBelow(self.surface, kMargin));
        return surfaceToDensity(*makeHeightFieldSource(self.name, self.surface, floor), options,
                                watched);
    });
    warn(result.warnings);
    return objectOf(result.grid);
}

py::list levelsOf(const SurfaceObject& self) {
    py::list levels;
    for (const FitLevel& level : self.fit->report) {
        py::dict one;
        one["level"] = level.level;
        one["cells"] = py::make_tuple(level.cells[0], level.cells[1]);
        one["largest"] = level.largest;
        one["rms"] = level.rms;
        levels.append(one);
    }
    return levels;
}

void defineReading(py::class_<SurfaceObject, SharedSurface>& surface) {
    surface.def(
        "__call__",
        [](const SurfaceObject& self, const py::object& x, const py::object& y, int column) {
            return evaluatedSurface(self, x, y, column, 1,
                                    [](const SurfaceJet& jet, double* to) { *to = jet.value; });
        },
        py::arg("x"), py::arg("y"), py::kw_only(), py::arg("column") = 0,
        "The values at places, arrays of any shapes that go together.");
    surface.def(
        "gradient",
        [](const SurfaceObject& self, const py::object& x, const py::object& y, int column) {
            return evaluatedSurface(self, x, y, column, 2, [](const SurfaceJet& jet, double* to) {
                to[0] = jet.dx;
                to[1] = jet.dy;
            });
        },
        py::arg("x"), py::arg("y"), py::kw_only(), py::arg("column") = 0,
        "(..., 2): the derivatives along x and y.");
    surface.def(
        "normals",
        [](const SurfaceObject& self, const py::object& x, const py::object& y, int column) {
            return evaluatedSurface(self, x, y, column, 3, [](const SurfaceJet& jet, double* to) {
                const std::array<double, 3> normal = jet.normal();
                std::copy(normal.begin(), normal.end(), to);
            });
        },
        py::arg("x"), py::arg("y"), py::kw_only(), py::arg("column") = 0,
        "(..., 3): the upward normals of the height field, of length 1.");
    surface.def(
        "curvature",
        [](const SurfaceObject& self, const py::object& x, const py::object& y, int column) {
            return evaluatedSurface(self, x, y, column, 2, [](const SurfaceJet& jet, double* to) {
                to[0] = jet.gaussianCurvature();
                to[1] = jet.meanCurvature();
            });
        },
        py::arg("x"), py::arg("y"), py::kw_only(), py::arg("column") = 0,
        "(..., 2): the Gaussian and the mean curvature, which is positive where the height field "
        "is hollow from above; per world unit squared, and per world unit.");
}

void defineMaking(py::class_<SurfaceObject, SharedSurface>& surface) {
    const DensityOptions standard;
    surface
        .def(
            "sample", &sampled, py::arg("samples") = 257, py::kw_only(),
            py::arg("quantities") = std::vector<std::string>{"value"},
            R"((x, y, numbers) float64: samples from border to border, so many along the longer side.

quantities: what there is of each column, some of 'value', 'dx', 'dy', 'dxx', 'dxy', 'dyy', 'normal'
(three numbers), 'gaussian' and 'mean'.)")
        .def("patches", &patchesOf, "The first column as bicubic Patches, which are it exactly.")
        .def("mesh", &meshOfSurface, py::arg("samples") = 257,
             "The height field of the first column as a Mesh with normals, and with colours if "
             "there "
             "are columns named r, g and b.")
        .def("save", &saveSurface, py::arg("path"), py::kw_only(), py::arg("samples") = 257,
             py::arg("quantities") = std::vector<std::string>{},
             "Writes .bpt patches, .npy samples, an .exr of heights, normals and positions, or a "
             "mesh (.obj, .ply, .stl, .gltf, .glb), whole or not at all. quantities: of .npy as of "
             "sample; of .exr channels besides.")
        .def(
            "density",
            [](const SurfaceObject& self, int resolution, double voxelSize,
               const std::optional<double>& base, double cutoff, double order, double tolerance,
               int threads, const py::object& progress) {
                DensityOptions options;
                options.resolution = resolution;
                options.voxelSize = voxelSize;
                options.filter = ExponentialFilter{order, cutoff};
                options.tolerance = tolerance;
                return densityUnder(self, base, options, threads, progress);
            },
            py::kw_only(), py::arg("resolution") = standard.resolution, py::arg("voxel_size") = 0.0,
            py::arg("base") = py::none(), py::arg("cutoff") = standard.filter.cutoff,
            py::arg("order") = standard.filter.order, py::arg("tolerance") = standard.tolerance,
            py::arg("threads") = 0, py::arg("progress") = py::none(),
            "The band-limited density of the solid under the first column, down to z = base, by "
            "default a tenth of its range below it; a Grid. Other arguments as of bandlimit.");
}

}  // namespace

std::array<int, 2> sampleCounts(const BsplineSurface& surface, int longer) {
    constexpr int kMostSamples = 32768;
    if (longer < 2 || longer > kMostSamples) {
        throw Error(ErrorKind::Usage,
                    "samples is " + std::to_string(longer) + "; expected 2 to 32768");
    }
    const double width = surface.rectangle().width(), height = surface.rectangle().height();
    const double step = std::max(width, height) / (longer - 1);
    const auto count = [&](double side) {
        return std::max(2, static_cast<int>(std::lround(side / step)) + 1);
    };
    return {count(width), count(height)};
}

ColoredMesh coloredSurface(const SurfaceObject& surface, double voxelSize) {
    const int red = app::redColumn(surface.columns);
    if (red < 0) {
        throw Error(ErrorKind::Usage,
                    "the surface has no columns named r, g and b; expected three of these names");
    }
    constexpr double kMostSamples = 4097;
    const Rectangle& r = surface.surface.rectangle();
    const double wanted = std::ceil(std::max(r.width(), r.height()) / voxelSize) + 1;
    const auto counts =
        sampleCounts(surface.surface, static_cast<int>(std::clamp(wanted, 2.0, kMostSamples)));
    return coloredHeightField(surface.name, surface.surface, counts, red);
}

BsplineSurface sumOf(const SurfaceFit& fit, const std::array<int, 2>& levels) {
    const auto count = static_cast<int>(fit.levels.size());
    if (levels[0] < 1 || levels[1] < levels[0] || levels[1] > count) {
        throw Error(ErrorKind::Usage, "levels: found " + std::to_string(levels[0]) + " to " +
                                          std::to_string(levels[1]) + "; expected some of 1 to " +
                                          std::to_string(count));
    }
    return fit.sum(static_cast<std::size_t>(levels[0]) - 1,
                   static_cast<std::size_t>(levels[1]) - 1);
}

void bindSurface(py::module_& module) {
    py::class_<SurfaceObject, SharedSurface> surface(
        module, "Surface",
        "A smooth surface over a rectangle, as fit makes it: a sum of cubic B-splines. Call it "
        "with "
        "x and y for its values. Safe to use from many threads.");
    defineReading(surface);
    defineMaking(surface);
    surface
        .def(
            "part",
            [](const SurfaceObject& self, int first, int last) {
                return std::make_shared<SurfaceObject>(SurfaceObject{
                    self.fit, sumOf(*self.fit, {first, last}), self.name, self.columns});
            },
            py::arg("first"), py::arg("last"),
            "The sum of the levels from first to last, as counted from 1: (1, 3) leaves detail "
            "away.")
        .def_property_readonly(
            "levels", &levelsOf,
            "A dictionary for each level, from coarse to fine: level, cells, and "
            "the largest difference and its rms left at the points, in parts of "
            "the values' range.")
        .def_property_readonly(
            "rectangle",
            [](const SurfaceObject& self) {
                const Rectangle& r = self.surface.rectangle();
                return py::make_tuple(r.x0, r.y0, r.x1, r.y1);
            },
            "x0, y0, x1, y1, world units.")
        .def_property_readonly(
            "columns", [](const SurfaceObject& self) { return self.surface.columns(); },
            "How many values there are at a place.")
        .def_readonly("column_names", &SurfaceObject::columns,
                      "Their names in the file that they come from; empty of arrays.")
        .def_property_readonly(
            "tension", [](const SurfaceObject& self) { return self.fit->tension; },
            "The tension that was used.")
        .def("__repr__", [](const SurfaceObject& self) {
            return "<bandvox.Surface of '" + self.name +
                   "': " + std::to_string(self.surface.cells()[0]) + " x " +
                   std::to_string(self.surface.cells()[1]) + " cells>";
        });
}

}  // namespace bandvox::python
