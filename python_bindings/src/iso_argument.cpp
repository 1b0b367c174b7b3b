#include "iso_argument.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/iso_of_volume.h>

#include <string>

namespace bandvox::python {

namespace py = pybind11;

IsoArgument isoArgumentOf(const py::handle& object) {
    if (object.is_none()) return {};
    if (py::isinstance<py::str>(object)) {
        const auto word = object.cast<std::string>();
        if (word == "volume") return {.byVolume = true};
        throw Error(ErrorKind::Usage, "iso is '" + word + "'; expected a number, 'volume' or None");
    }
    const double value = PyFloat_AsDouble(object.ptr());
    if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        throw Error(ErrorKind::Usage, std::string("iso: found a ") +
                                          Py_TYPE(object.ptr())->tp_name +
                                          "; expected a number, 'volume' or None");
    }
    return {.value = value};
}

std::optional<double> isoFor(const IsoArgument& argument, const openvdb::FloatGrid::ConstPtr& grid,
                             Progress& progress) {
    if (!argument.byVolume) return argument.value;
    const auto metadata = densityMetadata(*grid);
    const bool isKnown = metadata && metadata->sourceVolume > 0;
    return isoOfVolume(grid, isKnown ? metadata->sourceVolume : densityIntegral(*grid), progress)
        .iso;
}

}  // namespace bandvox::python
