#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace bandvox::python {

/// Text from a file, or with the name of one: what is not UTF-8 in it is escaped, as in "gr\xf6n".
inline pybind11::str textOf(const std::string& bytes) {
    PyObject* text = PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()),
                                          "backslashreplace");
    if (text == nullptr) throw pybind11::error_already_set();
    return pybind11::reinterpret_steal<pybind11::str>(text);
}

}  // namespace bandvox::python
