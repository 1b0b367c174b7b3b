// Smooth surfaces through values at scattered places of a plane.

#include "background.h"
#include "bindings.h"
#include "errors.h"
#include "scattered_arrays.h"
#include "solid_mesh.h"
#include "surface_object.h"

#include <bandvox/scatter/fit_surface.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <memory>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

/// What the user asked for has to be there; what holds otherwise is worth a warning.
void judge(const SurfaceFit& fit, const FitSurfaceOptions& options, bool hasTolerance) {
    constexpr double kTooFar = 1;
    if (fit.swing > kTooFar) {
        std::string message = "the surface goes beyond the values by " + inDigits(fit.swing);
        message += " of their range: noisy values need smooth, and points far apart a tension of ";
        warn({message + "more than " + inDigits(fit.tension)});
    }
    if (options.noise > 0) {
        constexpr double kNearly = 0.1;
        if (std::abs(fit.noiseLeft - 1) <= kNearly) return;
        std::string message = "the surface differs from the values by ";
        message += inDigits(fit.noiseLeft * options.noise);
        message += " in the root of the mean square; expected " + inDigits(options.noise);
        return warn({message + ", by smooth"});
    }
    judgeResidual({"surface", fit.report.back().largest, options.tolerance, hasTolerance,
                   options.maxLevel.has_value()});
}

SharedSurface fitted(const py::object& places, const py::object& values,
                     const std::vector<std::string>& columns, const FitSurfaceOptions& options,
                     bool hasTolerance, const std::optional<std::array<int, 2>>& levels,
                     int threads, const py::object& progress) {
    auto object = std::make_shared<SurfaceObject>();
    ScatteredInput input(places, values, columns, 2);
    if (!input.fileName().empty()) object->name = input.fileName();
    const SurfaceFit fit = inBackground(progress, threads, [&](Progress& watched) {
        const ScatteredPoints& points = input.points(watched);
        object->columns = points.names;
        return fitSurface(points, options, watched);
    });
    judge(fit, options, hasTolerance);
    object->surface = levels ? sumOf(fit, *levels) : fit.sum();
    object->fit = std::make_shared<SurfaceFit>(fit);
    return object;
}

}  // namespace

void bindFit(py::module_& module) {
    bindSurface(module);
    module.def(
        "fit",
        [](const py::object& places, const py::object& values,
           const std::vector<std::string>& columns,
           const std::optional<std::array<double, 4>>& rectangle,
           const std::optional<double>& tolerance, double smooth,
           const std::optional<int>& maxLevel, const std::optional<std::array<int, 2>>& levels,
           const std::optional<double>& tension, int threads, const py::object& progress) {
            FitSurfaceOptions options;
            if (rectangle) {
                options.rectangle =
                    Rectangle{(*rectangle)[0], (*rectangle)[1], (*rectangle)[2], (*rectangle)[3]};
            }
            if (tolerance && smooth != 0) {
                throw Error(ErrorKind::Usage, "tolerance and smooth exclude each other");
            }
            options.tolerance = tolerance.value_or(options.tolerance);
            options.noise = smooth;
            options.maxLevel = maxLevel;
            options.tension = tension;
            return fitted(places, values, columns, options, tolerance.has_value(), levels, threads,
                          progress);
        },
        py::arg("places"), py::arg("values") = py::none(), py::kw_only(),
        py::arg("columns") = std::vector<std::string>{}, py::arg("rectangle") = py::none(),
        py::arg("tolerance") = py::none(), py::arg("smooth") = 0.0,
        py::arg("max_level") = py::none(), py::arg("levels") = py::none(),
        py::arg("tension") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
        R"(Fits the smoothest sum of B-spline surfaces to values at scattered places; a Surface.

places: (n, 2), world units, and values: (n,) or (n, columns); or a .csv, .xyz, .txt or .npy file
alone, and columns: names, or numbers from 1, of x, y and values. rectangle: x0, y0, x1, y1, by
default that of the places. tolerance: how far it may be off at a point, in parts of the values'
range, 0 to 1; 1e-12 if it is None. smooth: the values have errors of this standard deviation, world
units; 0: none. max_level: at most 2**max_level cells along the longer side, 1 to 13. levels:
(first, last) to sum up. tension: stiff within 1 / tension, in units of the root of the rectangle's
area, and like a membrane farther off; 0.01 or more, and chosen if it is None.

Raises ResultError if a tolerance that is given is not reached, or the surface is off by more than
0.01 without a max_level.)");
}

}  // namespace bandvox::python
