#include "arrays.h"

#include <bandvox/core/error.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace bandvox::python {

namespace py = pybind11;

namespace {

[[noreturn]] void refuse(const char* what, const std::string& found, const std::string& expected) {
    throw Error(ErrorKind::Usage,
                std::string(what) + ": found " + found + "; expected " + expected);
}

bool isNumeric(const py::array& array) {
    const char kind = array.dtype().kind();
    return kind == 'f' || kind == 'i' || kind == 'u';
}

}  // namespace

py::array anyArray(const py::handle& object, const char* what, const std::string& expected) {
    // What is masked has values still, which nobody means.
    const bool isMasked = py::hasattr(object, "mask") &&
                          py::module_::import("numpy.ma").attr("is_masked")(object).cast<bool>();
    if (isMasked) refuse(what, "masked values", expected + ", as filled() makes them");
    py::array array = py::array::ensure(object);
    if (!array) {
        PyErr_Clear();
        refuse(what, std::string("a ") + Py_TYPE(object.ptr())->tp_name, expected);
    }
    return array;
}

std::string described(const py::array& array) {
    std::string text = "an array of shape (";
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
        if (axis > 0) text += ", ";
        text += std::to_string(array.shape(axis));
    }
    if (array.ndim() == 1) text += ',';
    return text + ") of " + py::str(array.dtype()).cast<std::string>();
}

py::array numericArray(const py::handle& object, const char* what, const std::string& expected) {
    py::array given = anyArray(object, what, expected);
    if (!isNumeric(given)) refuse(what, described(given), expected);
    return given;
}

std::vector<openvdb::Vec3d> vectorsOf(const py::handle& object, const char* what) {
    const std::string expected = "numbers of shape (n, 3)";
    const py::array given = anyArray(object, what, expected);
    if (given.ndim() != 2 || given.shape(1) != 3 || !isNumeric(given)) {
        refuse(what, described(given), expected);
    }
    const auto numbers = py::array_t<double, py::array::forcecast>::ensure(given);
    const auto rows = numbers.unchecked<2>();
    std::vector<openvdb::Vec3d> vectors(static_cast<std::size_t>(rows.shape(0)));
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
        vectors[static_cast<std::size_t>(i)] = {rows(i, 0), rows(i, 1), rows(i, 2)};
    }
    return vectors;
}

std::vector<openvdb::Vec3I> indicesOf(const py::handle& object, const char* what) {
    const std::string expected = "whole numbers from 0 of shape (n, 3)";
    const py::array given = anyArray(object, what, expected);
    const char kind = given.dtype().kind();
    if (given.ndim() != 2 || given.shape(1) != 3 || (kind != 'i' && kind != 'u')) {
        refuse(what, described(given), expected);
    }
    const auto numbers = py::array_t<std::int64_t, py::array::forcecast>::ensure(given);
    const auto rows = numbers.unchecked<2>();
    std::vector<openvdb::Vec3I> indices(static_cast<std::size_t>(rows.shape(0)));
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
        for (int k = 0; k < 3; ++k) {
            const std::int64_t index = rows(i, k);
            if (index < 0 || index > std::numeric_limits<std::int32_t>::max()) {
                refuse(what, std::to_string(index), expected);
            }
            indices[static_cast<std::size_t>(i)][k] = static_cast<openvdb::Index32>(index);
        }
    }
    return indices;
}

openvdb::Vec3d vectorOf(const py::handle& object, const char* what) {
    const std::string expected = "three numbers";
    const py::array given = anyArray(object, what, expected);
    if (!isNumeric(given) || given.ndim() > 1 || (given.ndim() == 1 && given.size() != 3)) {
        refuse(what, described(given), expected);
    }
    const auto numbers = py::array_t<double, py::array::forcecast>::ensure(given);
    if (given.ndim() == 0) return openvdb::Vec3d(*numbers.data());
    return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

py::array matrixOf(const openvdb::Mat4d& rows) {
    std::vector<double> numbers(16);
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) numbers[static_cast<std::size_t>(4 * i + j)] = rows(j, i);
    }
    return ownedArray(std::move(numbers), {4, 4});
}

openvdb::Mat4d mat4Of(const py::handle& object, const char* what) {
    const std::string expected = "numbers of shape (4, 4)";
    const py::array given = numericArray(object, what, expected);
    if (given.ndim() != 2 || given.shape(0) != 4 || given.shape(1) != 4) {
        refuse(what, described(given), expected);
    }
    const auto numbers = py::array_t<double, py::array::forcecast>::ensure(given);
    const auto columns = numbers.unchecked<2>();
    openvdb::Mat4d rows;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) rows(j, i) = columns(i, j);
    }
    return rows;
}

openvdb::Mat4d transformOf(const py::handle& object) {
    const openvdb::Mat4d rows = mat4Of(object, "transform");
    const bool isAffine = rows(0, 3) == 0 && rows(1, 3) == 0 && rows(2, 3) == 0 && rows(3, 3) == 1;
    if (!isAffine) refuse("transform", "another last row", "a last row 0 0 0 1");
    const double volume = rows.getMat3().det();
    if (!std::isfinite(volume) || volume == 0) {
        refuse("transform", "directions in one plane, or no numbers", "three directions");
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(rows(3, axis))) {
            refuse("transform", "a place that is not finite", "numbers");
        }
    }
    // What OpenVDB can invert.
    constexpr double kSmallestVolume = 3e-15;
    if (std::abs(volume) < kSmallestVolume) {
        refuse("transform", "voxels of a volume of " + std::to_string(volume), "3e-15 or more");
    }
    return rows;
}

}  // namespace bandvox::python
