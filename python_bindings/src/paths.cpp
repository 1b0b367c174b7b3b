#include "paths.h"

#include <bandvox/core/error.h>

#include <string>

namespace bandvox::python {

namespace py = pybind11;

bool isPath(const py::handle& source) {
    return py::isinstance<py::str>(source) || py::isinstance<py::bytes>(source) ||
           py::hasattr(source, "__fspath__");
}

std::filesystem::path pathOf(const py::handle& source) {
    const auto taken = [](PyObject* object) {
        if (object == nullptr) throw py::error_already_set();
        return py::reinterpret_steal<py::object>(object);
    };
    py::object name = taken(PyOS_FSPath(source.ptr()));
    if (py::isinstance<py::str>(name)) name = taken(PyUnicode_EncodeFSDefault(name.ptr()));
    auto bytes = name.cast<std::string>();
    if (bytes.find('\0') != std::string::npos) {
        throw Error(ErrorKind::Usage,
                    "a file's name has a zero byte; expected a name that files can have");
    }
    return bytes;
}

}  // namespace bandvox::python
