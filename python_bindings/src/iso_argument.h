#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>
#include <pybind11/pybind11.h>

#include <optional>

namespace bandvox::python {

/// The value that is a surface, as functions of Python take it: None, a number, or 'volume', the
/// one that encloses the volume of the source.
struct IsoArgument {
    std::optional<double> value;
    bool byVolume = false;

    bool isGiven() const { return value || byVolume; }
};

/// Throws Error(ErrorKind::Usage) for anything else.
IsoArgument isoArgumentOf(const pybind11::handle& object);

/// The value for a grid; nothing if none was given. Throws what isoOfVolume does.
std::optional<double> isoFor(const IsoArgument& argument, const openvdb::FloatGrid::ConstPtr& grid,
                             Progress& progress);

}  // namespace bandvox::python
