#include "callable_field.h"

#include "arrays.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>

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
    for (int axis = 0; axis < 3; ++axis) {
        const double low = corners[0][axis], high = corners[1][axis];
        if (low < high && std::isfinite(high - low)) continue;
        throw Error(ErrorKind::Usage, "bounds: found " + std::to_string(low) + " to " +
                                          std::to_string(high) +
                                          "; expected the lowest place and then the highest");
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
    if (const Progress* progress = mProgress) progress->throwIfInterrupted();
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
        const std::string expected =
            "one number, or numbers of shape (" + std::to_string(count) + ",)";
        const py::array found =
            anyArray(mFunction(places[0], places[1], places[2]), "the function's values", expected);
        const bool isNumber = std::string("fiub").find(found.dtype().kind()) != std::string::npos;
        const bool isOne = found.ndim() == 0;
        if (!isNumber || (!isOne && (found.ndim() != 1 || found.shape(0) != count))) {
            throw Error(ErrorKind::Usage, "the function's values: found " + described(found) +
                                              "; expected " + expected);
        }
        const auto numbers = py::array_t<float, py::array::forcecast>::ensure(found);
        for (py::ssize_t i = 0; i < count; ++i) {
            const float value = isOne ? *numbers.data() : numbers.at(i);
            if (!std::isfinite(value)) {
                throw Error(ErrorKind::Usage, "the function's values: found " +
                                                  std::to_string(value) +
                                                  "; expected finite numbers");
            }
            values[static_cast<std::size_t>(i)] = value;
        }
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
