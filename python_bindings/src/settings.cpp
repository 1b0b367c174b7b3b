#include "settings.h"

#include "arrays.h"

#include <bandvox/core/error.h>

#include <pybind11/stl.h>

namespace bandvox::python {

namespace py = pybind11;

py::object Settings::at(const char* name) const {
    return py::reinterpret_borrow<py::object>(mValues[name]);
}

openvdb::Vec3d Settings::vector(const char* name) const {
    return vectorOf(at(name), name);
}

std::optional<openvdb::Vec3d> Settings::optionalVector(const char* name) const {
    if (!isGiven(name)) return std::nullopt;
    return vector(name);
}

void Settings::fail(const char* name, const char* expected) const {
    throw Error(ErrorKind::Usage, std::string(name) + ": found " +
                                      py::repr(at(name)).cast<std::string>() + "; expected " +
                                      expected);
}

}  // namespace bandvox::python
