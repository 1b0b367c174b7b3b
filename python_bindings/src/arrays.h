#pragma once

#include <openvdb/openvdb.h>
#include <pybind11/numpy.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::python {

/// The shape and the type of an array, as in "(3, 4) of float64".
std::string described(const pybind11::array& array);

/// What can be made an array, as lists. Throws Error(ErrorKind::Usage) that says what was found and
/// `expected`.
pybind11::array anyArray(const pybind11::handle& object, const char* what,
                         const std::string& expected);

/// An array of numbers, of any type and shape. Throws Error(ErrorKind::Usage) that says what was
/// found and `expected`.
pybind11::array numericArray(const pybind11::handle& object, const char* what,
                             const std::string& expected);

/// Rows of three numbers, (n, 3), of any type that is one. Throws Error(ErrorKind::Usage) that says
/// `what` they are and what was found.
std::vector<openvdb::Vec3d> vectorsOf(const pybind11::handle& object, const char* what);

/// Rows of three whole numbers from 0, (n, 3). Throws as vectorsOf.
std::vector<openvdb::Vec3I> indicesOf(const pybind11::handle& object, const char* what);

/// Three numbers, or one for all three.
openvdb::Vec3d vectorOf(const pybind11::handle& object, const char* what);

/// A read-only view of rows of three numbers, which `owner` keeps alive.
template <typename Vector>
pybind11::array viewOf(const std::vector<Vector>& vectors, const pybind11::handle& owner) {
    using Number = typename Vector::ValueType;
    pybind11::array_t<Number> view(
        {static_cast<pybind11::ssize_t>(vectors.size()), static_cast<pybind11::ssize_t>(3)},
        reinterpret_cast<const Number*>(vectors.data()), owner);
    pybind11::detail::array_proxy(view.ptr())->flags &=
        ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return view;
}

/// An array that owns numbers of its own.
template <typename Number>
pybind11::array ownedArray(std::vector<Number> numbers, std::vector<pybind11::ssize_t> shape) {
    auto owned = std::make_unique<std::vector<Number>>(std::move(numbers));
    const Number* data = owned->data();
    const pybind11::capsule owner(
        owned.get(), [](void* pointer) { delete static_cast<std::vector<Number>*>(pointer); });
    owned.release();
    return pybind11::array_t<Number>(std::move(shape), data, owner);
}

/// A 4 x 4 matrix that acts on columns, as NumPy's `@` has it; OpenVDB's act on rows.
pybind11::array matrixOf(const openvdb::Mat4d& rows);

/// The other way. Throws Error(ErrorKind::Usage) unless it is 4 x 4 numbers.
openvdb::Mat4d mat4Of(const pybind11::handle& object, const char* what);

/// The same of a transform, with a last row 0 0 0 1.
openvdb::Mat4d transformOf(const pybind11::handle& object);

}  // namespace bandvox::python
