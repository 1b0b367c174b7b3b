#include "errors.h"

#include "text.h"

#include <bandvox/core/error.h>

#include <exception>

namespace bandvox::python {

namespace py = pybind11;

namespace {

// They live as long as the interpreter does.
PyObject* sError = nullptr;
PyObject* sUsage = nullptr;
PyObject* sInput = nullptr;
PyObject* sResult = nullptr;
PyObject* sMemory = nullptr;
PyObject* sWarning = nullptr;

PyObject* addException(py::module_& module, const char* name, const char* doc, PyObject* bases) {
    const std::string full = std::string("bandvox.") + name;
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases, nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.add_object(name, py::reinterpret_borrow<py::object>(type));
    return type;
}

PyObject* addBoth(py::module_& module, const char* name, const char* doc, PyObject* other) {
    const py::tuple bases = py::make_tuple(py::reinterpret_borrow<py::object>(sError),
                                           py::reinterpret_borrow<py::object>(other));
    return addException(module, name, doc, bases.ptr());
}

PyObject* typeOf(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Usage:
            return sUsage;
        case ErrorKind::Input:
            return sInput;
        case ErrorKind::Result:
            return sResult;
        case ErrorKind::Memory:
            return sMemory;
        case ErrorKind::Interrupted:
            return PyExc_KeyboardInterrupt;
        case ErrorKind::Runtime:
            break;
    }
    return sError;
}

void translate(std::exception_ptr pointer) {
    if (!pointer) return;
    try {
        std::rethrow_exception(pointer);
    } catch (const Error& error) {
        PyErr_SetObject(typeOf(error.kind()), textOf(error.what()).ptr());
    }
}

}  // namespace

void bindErrors(py::module_& module) {
    sError = addException(module, "Error", "What the library throws on purpose.", nullptr);
    sUsage = addBoth(module, "UsageError", "An argument is wrong.", PyExc_ValueError);
    sInput = addBoth(module, "InputError",
                     "The input cannot be used: missing, malformed, of the wrong kind.",
                     PyExc_ValueError);
    sResult = addBoth(module, "ResultError",
                      "The result would be empty, or worse than the tolerance asked for.",
                      PyExc_ArithmeticError);
    sMemory = addBoth(module, "OutOfMemoryError", "There is not enough memory.", PyExc_MemoryError);
    sWarning = addException(module, "BandvoxWarning",
                            "Something about an input or a result that a user should know.",
                            PyExc_UserWarning);
    py::register_exception_translator(&translate);
}

void warn(const std::vector<std::string>& warnings) {
    for (const std::string& text : warnings) {
        const auto readable = textOf(text).cast<std::string>();
        if (PyErr_WarnEx(sWarning, readable.c_str(), 1) != 0) throw py::error_already_set();
    }
}

}  // namespace bandvox::python
