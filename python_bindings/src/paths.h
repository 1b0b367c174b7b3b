#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>

namespace bandvox::python {

/// True of what names a file: text, bytes, and objects of pathlib.
bool isPath(const pybind11::handle& source);

/// The file that such an object names. Throws Error(ErrorKind::Usage) for a name that no file has.
std::filesystem::path pathOf(const pybind11::handle& source);

}  // namespace bandvox::python
