#include "density_request.h"

#include "background.h"
#include "errors.h"
#include "grid_object.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace bandvox::python {

namespace py = pybind11;

namespace {

std::string inTwoDigits(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", number);
    return text;
}

// The default tolerance of sampling warns; one that was asked for has to be kept.
void requireTolerance(const DensityRequest& request, const DensityMetadata& metadata) {
    if (metadata.route == "exact" || !request.tolerance) return;
    const double error = metadata.samplingError;
    if (std::isnan(error)) {
        throw Error(ErrorKind::Result,
                    "the sampling error is not known for an odd oversample, so it cannot be told "
                    "to keep to the tolerance asked for, " +
                        inTwoDigits(*request.tolerance) + "; expected an even one");
    }
    if (error <= *request.tolerance) return;
    throw Error(ErrorKind::Result, "the sampling error of " + inTwoDigits(error) +
                                       " is above the tolerance asked for, " +
                                       inTwoDigits(*request.tolerance) +
                                       "; expected a larger oversample or tolerance, or a closed "
                                       "mesh");
}

}  // namespace

DensityRequest densityRequestOf(const FilterArguments& filter,
                                const std::optional<double>& tolerance, const py::object& iso,
                                int threads, const py::object& progress) {
    DensityRequest request;
    DensityOptions& options = request.options;
    options.filter = ExponentialFilter{filter.order, filter.cutoff};
    options.tile = filter.tile;
    options.clamp = filter.clamp;
    options.tolerance = tolerance.value_or(options.tolerance);
    request.tolerance = tolerance;
    request.iso = isoArgumentOf(iso);
    options.iso = request.iso.value.value_or(options.iso);
    request.threads = threads;
    request.progress = progress;
    return request;
}

Shard shardOf(const py::object& object) {
    if (object.is_none()) return {};
    try {
        const auto numbers = object.cast<std::array<int, 2>>();
        const Shard shard{numbers[0], numbers[1]};
        requireValid(shard);
        return shard;
    } catch (const py::cast_error&) {
        throw Error(ErrorKind::Usage, "shard: found " + py::repr(object).cast<std::string>() +
                                          "; expected (i, n), part i of n from 1");
    }
}

py::object madeDensity(const DensityRequest& request,
                       const std::function<DensityResult(Progress&)>& make) {
    if (request.iso.byVolume && !request.options.shard.isWhole()) {
        throw Error(ErrorKind::Usage, "iso='volume' has no meaning with shard: it needs the whole");
    }
    const DensityResult result =
        inBackground(request.progress, request.threads, [&](Progress& progress) {
            DensityResult made = make(progress);
            requireTolerance(request, made.metadata);
            if (request.iso.byVolume) {
                made.metadata.iso = *isoFor(request.iso, made.grid, progress);
            }
            setDensityMetadata(*made.grid, made.metadata);
            return made;
        });
    warn(result.warnings);
    return objectOf(result.grid);
}

}  // namespace bandvox::python
