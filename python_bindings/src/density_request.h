#pragma once

#include "iso_argument.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/core/progress.h>

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>

namespace bandvox::python {

/// What the functions that make a density have in common.
struct DensityRequest {
    DensityOptions options;  ///< the tolerance of all but sampling
    IsoArgument iso;
    /// Error that was asked for, density; nothing if nothing was said.
    std::optional<double> tolerance;
    int threads = 0;
    pybind11::object progress;
};

/// How densities are filtered: cycles per voxel, order, voxels.
struct FilterArguments {
    double cutoff, order;
    int tile;
    bool clamp;
};

DensityRequest densityRequestOf(const FilterArguments& filter,
                                const std::optional<double>& tolerance, const pybind11::object& iso,
                                int threads, const pybind11::object& progress);

/// A part (i, n) of the work; the whole of it for None. Throws Error(ErrorKind::Usage).
Shard shardOf(const pybind11::object& object);

/// Makes a density in the background, sees to its iso-value and the error that was asked for, and
/// warns. Throws Error(ErrorKind::Result) if sampling left more than that.
pybind11::object madeDensity(const DensityRequest& request,
                             const std::function<DensityResult(Progress&)>& make);

}  // namespace bandvox::python
