#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace bandvox::python {

/// The exceptions that stand for bandvox::Error, by its kind.
void bindErrors(pybind11::module_& module);

/// Says what the library would say to a user, by Python's warnings.
void warn(const std::vector<std::string>& warnings);

}  // namespace bandvox::python
