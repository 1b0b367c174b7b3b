#include "callable_field.h"

#include "arrays.h"

#include <bandvox/core/error.h>

#include <algorithm>

namespace bandvox::python {

namespace py = pybind11;

openvdb::BBoxd boundsOfFunction(const py::object& bounds) {
    if (bounds.is_none()) {
        throw Error(ErrorKind::Usage,
                    "a function needs bounds; expected the lowest and the highest place where it "
                    "is not 0, as ((-1, -1, -1), (1, 1, 1))");
    }
    const auto corners = vectorsOf(bounds, "bounds");
    if (corners.size() != 2) {
        throw Error(ErrorKind::Usage, "bounds: found " + std::to_string(corners.size()) +
                                          " places; expected the lowest and the highest");
    }
    return {corners[0], corners[1]};
}

CallableField::CallableField(py::object function, const openvdb::BBoxd& bounds)
    : mFunction(std::move(function)), mBounds(bounds) {
    const py::object name = py::getattr(mFunction, "__name__", py::str("function"));
    mName = py::str(name).cast<std::string>();
}

void CallableField::sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                              std::span<float> values) const {
    if (mHasFailed) throw Error(ErrorKind::Interrupted, "the function has thrown");
    const py::gil_scoped_acquire locked;
    try {
        const auto count = static_cast<py::ssize_t>(values.size());
        py::object places[3];
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> along(values.size());
            for (std::size_t i = 0; i < along.size(); ++i) {
                along[i] = start[axis] + static_cast<double>(i) * step[axis];
            }
            places[axis] = ownedArray(std::move(along), {count});
        }
        const py::object found = mFunction(places[0], places[1], places[2]);
        const auto array = py::array_t<float, py::array::forcecast>::ensure(found);
        if (!array) throw py::error_already_set();
        if (array.ndim() == 0) {
            std::fill(values.begin(), values.end(), *array.data());
            return;
        }
        if (array.ndim() != 1 || array.shape(0) != count) {
            throw Error(ErrorKind::Usage, "the function gave " + described(array) +
                                              "; expected one of shape (" + std::to_string(count) +
                                              ",)");
        }
        const auto numbers = array.unchecked<1>();
        for (py::ssize_t i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = numbers(i);
    } catch (...) {
        // An exception of Python may only be touched with the lock, so the first one stays here.
        if (!mHasFailed) {
            mFailure = std::current_exception();
            mHasFailed = true;
        }
    }
    if (mHasFailed) throw Error(ErrorKind::Interrupted, "the function has thrown");
}

void CallableField::rethrow() const {
    if (mHasFailed) std::rethrow_exception(mFailure);
}

}  // namespace bandvox::python
